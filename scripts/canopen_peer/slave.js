#!/usr/bin/env node
// SPDX-License-Identifier: BSD-3-Clause
// A CiA 402 drive on npm's canopen: its NMT, heartbeat, SDO server, PDO and SYNC; the drive's states are scripted here.
// Frames on stdin and stdout, one a line as cansend writes them: 181#2706E8030000F4FF. bridge.py connects them to a line.
// usage: slave.js NODE [MISSING_INDEX_HEX...]
'use strict';

const readline = require('readline');
const { Device, DataType, AccessType } = require('canopen');

const node = Number(process.argv[2]);
const missing = new Set(process.argv.slice(3).map((index) => parseInt(index, 16)));
const device = new Device({ id: node });
const { eds } = device;

function addObject(index, dataType, value = 0) {
  if (missing.has(index)) return undefined;
  const entry = eds.addEntry(index, { parameterName: `object ${index.toString(16)}`, dataType, accessType: AccessType.READ_WRITE });
  entry.value = value;
  return entry;
}

function addRecord(index, dataTypes) {
  const record = eds.addEntry(index, { parameterName: `record ${index.toString(16)}`, objectType: 9 });
  for (const [subIndex, dataType] of dataTypes.entries()) {
    eds.addSubEntry(index, subIndex + 1, { parameterName: `field ${subIndex + 1}`, dataType, accessType: AccessType.READ_WRITE });
  }
  return record;
}

const { UNSIGNED8, UNSIGNED16, UNSIGNED32, INTEGER8, INTEGER16, INTEGER32 } = DataType;
if (eds.getEntry(0x1000)) eds.removeEntry(0x1000);
addObject(0x1000, UNSIGNED32, 0x00020192);
addObject(0x1006, UNSIGNED32);
eds.addSdoServerParameter(node, 0x580 + node, 0x600 + node);
eds.setSyncCobId(0x80);
eds.setEmcyCobId(0x80 + node);
addObject(0x1017, UNSIGNED16, 100);
eds.addHeartbeatConsumer(0x7F, 150);
addRecord(0x1029, [UNSIGNED8]);
for (const index of [0x6007, 0x605A, 0x605E]) addObject(index, INTEGER16);
for (const index of [0x6065, 0x607F, 0x6080, 0x60C5, 0x6085]) addObject(index, UNSIGNED32);
addObject(0x6066, UNSIGNED16);
addRecord(0x607D, [INTEGER32, INTEGER32]);
addRecord(0x60C2, [UNSIGNED8, INTEGER8]);
addObject(0x6060, INTEGER8);
const controlWord = addObject(0x6040, UNSIGNED16);
const target = addObject(0x607A, INTEGER32);
const maxTorque = addObject(0x6072, UNSIGNED16);
const statusWord = addObject(0x6041, UNSIGNED16, 0x0240);
const position = addObject(0x6064, INTEGER32, 1000);
const torque = addObject(0x6077, INTEGER16, 100);
const errorCode = addObject(0x603F, UNSIGNED16);
const modeDisplay = addObject(0x6061, INTEGER8, 8);
const inputs = addObject(0x60FD, UNSIGNED32);

// The library's mapping is fixed when it starts; what SDO writes to it later only shows in the dictionary.
const commands = [controlWord, target, maxTorque].filter(Boolean);
const numCommandBytes = maxTorque ? 8 : 6;
eds.addReceivePdo({ cobId: 0x200 + node, transmissionType: 1, dataObjects: commands });
eds.addTransmitPdo({ cobId: 0x180 + node, transmissionType: 1, dataObjects: [statusWord, position, torque].filter(Boolean) });
eds.addTransmitPdo({ cobId: 0x280 + node, transmissionType: 254, eventTime: 100, dataObjects: [errorCode, modeDisplay, inputs] });
for (const index of [0x1600, 0x1A00, 0x1A01]) {
  const count = eds.getSubEntry(index, 0);
  count.accessType = AccessType.READ_WRITE;
}

const NEXT = { // statusword & 6Fh -> what a controlword's low bits lead to
  0x40: { 0x06: 0x0221 },
  0x21: { 0x07: 0x0223 },
  0x23: { 0x0F: 0x0227, 0x06: 0x0221 },
  0x27: { 0x07: 0x0223, 0x0B: 0x0207 },
  0x07: { 0x0F: 0x0227 },
};

function follow() {
  const word = controlWord.value & 0x0F;
  const now = statusWord.value & 0x6F;
  if ((word & 0x02) === 0) statusWord.value = 0x0240;
  else if (NEXT[now] && NEXT[now][word]) statusWord.value = NEXT[now][word];
  if ((statusWord.value & 0x6F) === 0x27) position.value = target.value;
}
// The master is gone: what 6007h = 3 and 605Ah = 6 ask for.
device.nmt.on('timeout', () => {
  const abort = eds.getEntry(0x6007);
  if (abort && abort.value === 3 && (statusWord.value & 0x6F) === 0x27) statusWord.value = 0x0207;
});

device.on('message', ({ id, data }) => {
  process.stdout.write(`${id.toString(16).toUpperCase().padStart(3, '0')}#${Buffer.from(data || []).toString('hex').toUpperCase()}\n`);
});
let isCommanded = false;
const lines = readline.createInterface({ input: process.stdin });
lines.on('line', (line) => {
  const [id, bytes] = line.trim().split('#');
  const data = Buffer.from(bytes, 'hex');
  const cobId = parseInt(id, 16);
  if (cobId === 0x200 + node) {
    isCommanded = data.length === numCommandBytes;
    if (!isCommanded) { // as drives do that are told more or less than they are mapped to
      device.emcy.write(0x8220);
      return;
    }
  }
  if (cobId === 0x80 && isCommanded) { // what the RPDO of this cycle brought becomes valid
    isCommanded = false;
    follow();
  }
  device.receive({ id: cobId, data, len: data.length });
});
lines.on('close', () => process.exit(0));
device.start();
