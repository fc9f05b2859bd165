// SPDX-License-Identifier: BSD-3-Clause
// Buffers that are filled anew with every message and made larger only when they must.

import { BufferAttribute } from "three";

/** Puts values into an attribute ("index" too) of a geometry; only these are drawn. */
export function fill(geometry, name, values, itemSize) {
  const old = name === "index" ? geometry.index : geometry.getAttribute(name);
  if (old && old.array.length >= values.length) {
    old.array.set(values);
    old.needsUpdate = true;
    return;
  }
  const array = new values.constructor(Math.ceil(values.length * 1.5));
  array.set(values);
  const attribute = new BufferAttribute(array, itemSize);
  if (name === "index") geometry.setIndex(attribute);
  else geometry.setAttribute(name, attribute);
}

/** xyz, xyz, ... from three columns of a message. */
export function interleave(x, y, z) {
  const values = new Float32Array(3 * x.length);
  for (let i = 0; i < x.length; ++i) {
    values[3 * i] = x[i];
    values[3 * i + 1] = y[i];
    values[3 * i + 2] = z[i];
  }
  return values;
}
