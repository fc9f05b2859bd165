// SPDX-License-Identifier: BSD-3-Clause
// Each sample in a log of one message per channel (publish_samples) decodes with the page's decoder and encodes again to the same bytes;
// a message cut short, one of another version and one with bytes left over are refused.
//   node decode_test.mjs FOLDER_OF_decode.js_AND_messages.js SAMPLES_LOG
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { resolve } from "node:path";

const [folder, log] = process.argv.slice(2);
const load = (name) => import(pathToFileURL(resolve(folder, name)).href);
const { decode } = await load("decode.js");
const { TYPES } = await load("messages.js");

const SET = { int8_t: "setInt8", int16_t: "setInt16", int32_t: "setInt32", int64_t: "setBigInt64", float: "setFloat32", double: "setFloat64" };
const BYTES = { byte: 1, boolean: 1, int8_t: 1, int16_t: 2, int32_t: 4, int64_t: 8, float: 4, double: 8 };

/** Written apart from the decoder: fields in order, big-endian. */
function encode(fingerprint, type, message) {
  const parts = [Buffer.from(fingerprint, "hex")];
  for (const [name, kind] of type.fields) {
    if (kind === "string") {
      const text = Buffer.from(`${message[name]}\0`);
      const length = Buffer.alloc(4);
      length.writeInt32BE(text.length);
      parts.push(length, text);
      continue;
    }
    const values = ArrayBuffer.isView(message[name]) ? message[name] : [message[name]];
    const bytes = new DataView(new ArrayBuffer(values.length * BYTES[kind]));
    values.forEach((value, i) => bytes[SET[kind] ?? "setUint8"](i * BYTES[kind], value));
    parts.push(Buffer.from(bytes.buffer));
  }
  return Buffer.concat(parts);
}

function* messages(bytes) {
  for (let at = 0; at < bytes.length;) {
    assert.equal(bytes.readUInt32BE(at), 0xeda1da01);
    const start = at + 28 + bytes.readUInt32BE(at + 20);
    at = start + bytes.readUInt32BE(at + 24);
    yield bytes.subarray(start, at);
  }
}

const view = (bytes) => new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
const found = new Set();
for (const bytes of messages(readFileSync(log))) {
  const message = decode(view(bytes));
  const fingerprint = bytes.subarray(0, 8).toString("hex");
  assert.equal(message.type, TYPES[fingerprint].name);
  assert.ok(encode(fingerprint, TYPES[fingerprint], message).equals(bytes), `${message.type} does not encode to the same bytes`);
  found.add(message.type);

  assert.throws(() => decode(view(bytes.subarray(0, bytes.length - 1))), undefined, "cut short");
  assert.throws(() => decode(view(Buffer.concat([bytes, Buffer.alloc(1)]))), /left over/);
  assert.throws(() => decode(view(Buffer.concat([Buffer.alloc(8), bytes.subarray(8)]))), /another version/);
}
assert.equal(found.size, Object.keys(TYPES).length, "a type has no sample");
console.log(`${found.size} types`);
