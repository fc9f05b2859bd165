// SPDX-License-Identifier: BSD-3-Clause
// Stands in for npm's node-crc, which needs a compiler to install. canopen asks for it only in SDO block transfers.
module.exports = {
  crc() {
    throw new Error('SDO block transfer is not used here');
  },
};
