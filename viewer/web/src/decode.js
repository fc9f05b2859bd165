// SPDX-License-Identifier: BSD-3-Clause
// An LCM message as an object, read with the tables that write_messages.py makes from the .lcm files. Arrays become typed arrays,
// int64 becomes BigInt, so that nothing is rounded. The server passes on sound messages only; what is none of them throws.

import { TYPES } from "./messages.js";

const ARRAYS = {
  byte: [Uint8Array, 1],
  boolean: [Uint8Array, 1],
  int8_t: [Int8Array, 1, "getInt8"],
  int16_t: [Int16Array, 2, "getInt16"],
  int32_t: [Int32Array, 4, "getInt32"],
  int64_t: [BigInt64Array, 8, "getBigInt64"],
  float: [Float32Array, 4, "getFloat32"],
  double: [Float64Array, 8, "getFloat64"],
};

class Reader {
  constructor(view) {
    this.view = view;
    this.at = 0;
  }

  numbers(kind, count) {
    const [Numbers, bytes, get] = ARRAYS[kind];
    const values = new Numbers(count);
    const { view } = this;
    for (let i = 0, at = this.at; i < count; ++i, at += bytes) values[i] = get ? view[get](at) : view.getUint8(at);
    this.at += count * bytes;
    return values;
  }

  text() {
    const length = this.view.getInt32(this.at);
    const bytes = new Uint8Array(this.view.buffer, this.view.byteOffset + this.at + 4, length - 1); // without the NUL
    this.at += 4 + length;
    return new TextDecoder().decode(bytes);
  }
}

/** The message in a DataView: {type: "pose_t", utime: 1n, ...}. */
export function decode(view) {
  const type = TYPES[view.getBigUint64(0).toString(16).padStart(16, "0")];
  if (!type) throw new Error("a message of another version");
  const reader = new Reader(new DataView(view.buffer, view.byteOffset + 8, view.byteLength - 8));
  const values = [];
  const message = { type: type.name };
  for (const [name, kind, fixed, countIndex] of type.fields) {
    let value;
    if (kind === "string") value = reader.text();
    else if (countIndex >= 0) value = reader.numbers(kind, values[countIndex]);
    else if (fixed > 0) value = reader.numbers(kind, fixed);
    else value = reader.numbers(kind, 1)[0];
    values.push(value);
    message[name] = value;
  }
  if (reader.at !== view.byteLength - 8) throw new Error(`${type.name} with bytes left over`);
  return message;
}
