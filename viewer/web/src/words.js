// SPDX-License-Identifier: BSD-3-Clause
// Enumerations in words, from the constants of the message types: STATE_FAULT_HOLD is "fault hold".

const inWords = (constant, prefix) => constant.slice(prefix.length).toLowerCase().replaceAll("_", " ");

/** "fault hold" for (climb_state_t, "STATE_", 9); the number where it has no name. */
export function nameOf(type, prefix, value) {
  const constant = Object.keys(type).find((name) => name.startsWith(prefix) && type[name] === Number(value));
  return constant ? inWords(constant, prefix) : String(value);
}

/** The names of the bits set in value. */
export function flagsOf(type, prefix, value) {
  const bits = BigInt(value);
  return Object.keys(type)
    .filter((name) => name.startsWith(prefix) && (bits & BigInt(type[name])) !== 0n)
    .map((name) => inWords(name, prefix));
}

/** Names by value, for tables that are looked up often: namesOf(ladder_t, "REASON_")[3] is "rail too near". */
export function namesOf(type, prefix) {
  const constants = Object.entries(type).filter(([name]) => name.startsWith(prefix));
  return Object.fromEntries(constants.map(([name, value]) => [value, inWords(name, prefix)]));
}

export const timeOfDay = (us) => new Date(us / 1000).toLocaleTimeString("en-GB") + "." + String(Math.floor(us / 1e5) % 10);
