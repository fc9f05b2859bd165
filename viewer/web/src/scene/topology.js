// SPDX-License-Identifier: BSD-3-Clause
// Nodes, edges and faces. Hue is the class (safe ground, wall, obstacle); the stronger a node, the larger and the lighter. One buffer of
// positions and one of colours serve all three.

import { BufferGeometry, Color, DoubleSide, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, Points, ShaderMaterial } from "three";
import { topology_t as Topology } from "../messages.js";
import { fill, interleave } from "./buffers.js";

export const CLASS_COLORS = {
  [Topology.CLASS_UNKNOWN]: "#8b93a7",
  [Topology.CLASS_SAFE_GROUND]: "#4fb06d",
  [Topology.CLASS_WALL]: "#4f7fd6",
  [Topology.CLASS_OBSTACLE]: "#f0883e",
};
const CLASSES = Object.entries(CLASS_COLORS).reduce((colors, [value, color]) => Object.assign(colors, { [value]: new Color(color) }), {});
const STRONG = 10; // at this strength a node is as light and as large as it gets

const vertexShader = `
  attribute vec3 color;
  attribute float strength;
  varying vec3 shade;
  uniform float pixels;
  void main() {
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * place;
    gl_PointSize = clamp((0.010 + 0.012 * strength) * pixels / -place.z, 2.0, 24.0);
    shade = color;
  }`;
const fragmentShader = `
  varying vec3 shade;
  void main() {
    if (length(gl_PointCoord - 0.5) > 0.5) discard;
    gl_FragColor = vec4(shade, 1.0);
    #include <colorspace_fragment>
  }`;

export class TopologyModel {
  constructor(scene) {
    const geometry = () => new BufferGeometry();
    this.nodes = new Points(geometry(), new ShaderMaterial({ vertexShader, fragmentShader, uniforms: { pixels: { value: 800 } } }));
    this.edges = new LineSegments(geometry(), new LineBasicMaterial({ vertexColors: true, transparent: true, opacity: 0.45 }));
    this.faces = new Mesh(geometry(), new MeshBasicMaterial({ vertexColors: true, side: DoubleSide, transparent: true, opacity: 0.22, depthWrite: false }));
    for (const part of [this.nodes, this.edges, this.faces]) {
      part.frustumCulled = false; // its bounds change with every message
      scene.add(part);
    }
  }

  show(message) {
    const positions = interleave(message.node_x_m, message.node_y_m, message.node_z_m);
    const count = message.num_nodes;
    const colors = new Float32Array(3 * count);
    const strengths = new Float32Array(count);
    const color = new Color();
    for (let i = 0; i < count; ++i) {
      strengths[i] = Math.min(1, Math.max(0, (message.node_strength[i] - 1) / (STRONG - 1)));
      color.copy(CLASSES[message.node_class[i]] ?? CLASSES[0]).lerp(WHITE, 0.45 * strengths[i]).toArray(colors, 3 * i);
    }
    for (const { geometry } of [this.nodes, this.edges, this.faces]) {
      fill(geometry, "position", positions, 3);
      fill(geometry, "color", colors, 3);
    }
    fill(this.nodes.geometry, "strength", strengths, 1);
    this.nodes.geometry.setDrawRange(0, count);
    this.connect(this.edges.geometry, [message.edge_a, message.edge_b]);
    this.connect(this.faces.geometry, [message.face_a, message.face_b, message.face_c]);
  }

  connect(geometry, columns) {
    const index = new Uint32Array(columns.length * columns[0].length);
    columns.forEach((column, corner) => column.forEach((node, i) => (index[columns.length * i + corner] = node)));
    fill(geometry, "index", index, 1);
    geometry.setDrawRange(0, index.length);
  }

  hide() {
    for (const { geometry } of [this.nodes, this.edges, this.faces]) geometry.setDrawRange(0, 0);
  }
}

const WHITE = new Color("#ffffff");
