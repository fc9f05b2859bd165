// SPDX-License-Identifier: BSD-3-Clause
// The 3-D scene in the odom frame, z up. It is drawn when something has changed and not otherwise.

import { AmbientLight, Color, DirectionalLight, GridHelper, Object3D, PerspectiveCamera, Raycaster, Scene as Space, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { element } from "../element.js";
import { LADDER_COLORS, LadderModel } from "./ladder.js";
import { RobotModel } from "./robot.js";
import { CLASS_COLORS, TopologyModel } from "./topology.js";
import { TRUTH_COLOR, TruthModel } from "./truth.js";

const BACKGROUND = "#12151d";
const POSE_SILENT_MS = 1000;
/** At first the eye is behind the robot, to its right, and looks at what is before it. */
const FIRST_EYE = new Vector3(-1.5, -1.7, 0.8);
const FIRST_TARGET = new Vector3(0.5, 0, 0.25);
const LEGEND = [["safe ground", CLASS_COLORS[1]], ["wall", CLASS_COLORS[2]], ["obstacle", CLASS_COLORS[3]], ["rung, trusted", LADDER_COLORS.trusted],
  ["candidate", LADDER_COLORS.candidate], ["may grasp", LADDER_COLORS.free], ["may not", LADDER_COLORS.refused], ["truth", TRUTH_COLOR]];

Object3D.DEFAULT_UP.set(0, 0, 1);

export class Scene {
  constructor(place, legend, layers, hint) {
    this.place = place;
    this.hint = hint;
    this.space = new Space();
    this.space.background = new Color(BACKGROUND);
    const sun = new DirectionalLight("#ffffff", 2);
    sun.position.set(-2, 1, 3);
    this.grid = new GridHelper(8, 16, "#3a4258", "#242a38").rotateX(Math.PI / 2);
    this.topology = new TopologyModel(this.space);
    this.ladder = new LadderModel(this.space);
    this.robot = new RobotModel();
    this.truth = new TruthModel();
    this.space.add(sun, new AmbientLight("#ffffff", 1.2), this.grid, this.robot, this.truth);
    this.openEyes(place);
    legend.append(...LEGEND.map(([name, color]) => element("span", { style: `--color: ${color}` }, name)));
    this.offerLayers(layers);
  }

  openEyes(place) {
    this.camera = new PerspectiveCamera(50, 1, 0.02, 60);
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    place.prepend(this.renderer.domElement);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.lookFrom(new Vector3());
    this.controls.addEventListener("change", () => (this.isChanged = true));
    new ResizeObserver(() => this.resize()).observe(place);
    this.renderer.domElement.addEventListener("pointermove", (event) => this.point(event));
  }

  offerLayers(place) {
    const layers = { nodes: this.topology.nodes, edges: this.topology.edges, faces: this.topology.faces, rungs: this.ladder.rungs,
      grasps: this.ladder.affordances, truth: this.truth, floor: this.grid };
    for (const [name, layer] of Object.entries(layers)) {
      const box = element("input", { type: "checkbox" });
      box.checked = true;
      box.onchange = () => {
        layer.visible = box.checked;
        this.isChanged = true;
      };
      place.append(element("label", {}, box, name));
    }
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (!width || !height) return;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setSize(width, height);
    this.topology.nodes.material.uniforms.pixels.value = height * this.renderer.getPixelRatio();
    this.isChanged = true;
  }

  topology_t(message) {
    this.topology.show(message);
    this.grid.position.z = floorHeight(message);
    if (performance.now() - (this.poseMs ?? -Infinity) > POSE_SILENT_MS) this.stand(message.p_odom_body_m, message.q_odom_body);
    this.isChanged = true;
  }

  ladder_t(message) {
    this.ladder.show(message);
    this.isChanged = true;
  }

  truth_t(message) {
    this.truth.show(message);
    this.isChanged = true;
  }

  pose_t(message) {
    this.poseMs = performance.now();
    this.stand(message.p_odom_body_m, message.q_odom_body);
  }

  climb_state_t(message) {
    this.robot.bend(message);
    this.isChanged = true;
  }

  lookFrom(place) {
    this.camera.position.copy(place).add(FIRST_EYE);
    this.controls.target.copy(place).add(FIRST_TARGET);
  }

  /** The camera goes along with the robot, from wherever it looks. */
  stand(p, q) {
    const place = new Vector3(...p);
    if (this.robot.visible) {
      const moved = place.sub(this.robot.position);
      this.camera.position.add(moved);
      this.controls.target.add(moved);
    } else this.lookFrom(place);
    this.robot.stand(p, q);
    this.isChanged = true;
  }

  forget() {
    for (const model of [this.topology, this.ladder, this.robot, this.truth]) model.hide();
    this.isChanged = true;
  }

  /** What is under the pointer, in words. */
  point(event) {
    const area = this.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(((event.clientX - area.left) / area.width) * 2 - 1, 1 - ((event.clientY - area.top) / area.height) * 2);
    const ray = new Raycaster();
    ray.setFromCamera(at, this.camera);
    const bars = [this.ladder.affordances, this.ladder.rungs, this.truth].filter((layer) => layer.visible);
    const met = ray.intersectObjects(bars).find(({ object }) => object.visible && object.userData.hint);
    this.hint.hidden = !met;
    if (!met) return;
    this.hint.textContent = met.object.userData.hint;
    this.hint.style.transform = `translate(${event.clientX - area.left + 14}px, ${event.clientY - area.top + 14}px)`;
  }

  draw() {
    this.controls.update();
    if (!this.isChanged) return;
    this.isChanged = false;
    this.renderer.render(this.space, this.camera);
  }
}

/** Where the grid belongs: the lowest plane of safe ground, else where it was put first. */
function floorHeight(message) {
  let lowest = Infinity;
  for (let i = 0; i < message.num_planes; ++i) {
    if (message.plane_class[i] === 1 && message.plane_normal_z[i] > 0.9) lowest = Math.min(lowest, message.plane_offset_m[i] / message.plane_normal_z[i]);
  }
  return Number.isFinite(lowest) ? lowest : 0;
}
