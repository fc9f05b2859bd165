// SPDX-License-Identifier: BSD-3-Clause
// Round bars between two points: rungs, rails, stretches, limbs. The same meshes are used again from message to message.

import { CylinderGeometry, Group, Mesh, MeshStandardMaterial, Quaternion, Vector3 } from "three";

const UNIT = new CylinderGeometry(1, 1, 1, 12, 1);
const ALONG_Y = new Vector3(0, 1, 0);
const axis = new Vector3();
const turn = new Quaternion();

export class Bars extends Group {
  /** bars: [{from: [x, y, z], to: [x, y, z], radius, color, opacity, hint}] */
  show(bars) {
    while (this.children.length < bars.length) this.add(new Mesh(UNIT, new MeshStandardMaterial({ roughness: 0.7, transparent: true })));
    this.children.forEach((mesh, i) => {
      mesh.visible = i < bars.length;
      if (mesh.visible) this.place(mesh, bars[i]);
    });
  }

  place(mesh, { from, to, radius, color, opacity = 1, hint = "" }) {
    axis.set(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
    const length = axis.length() || 1e-6;
    mesh.position.set((from[0] + to[0]) / 2, (from[1] + to[1]) / 2, (from[2] + to[2]) / 2);
    mesh.quaternion.copy(turn.setFromUnitVectors(ALONG_Y, axis.divideScalar(length)));
    mesh.scale.set(radius, length, radius);
    mesh.material.color.set(color);
    mesh.material.opacity = opacity;
    mesh.material.depthWrite = opacity >= 1;
    mesh.userData.hint = hint;
  }
}
