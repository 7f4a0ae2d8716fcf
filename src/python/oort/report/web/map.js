// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

const COLOURS = {
  states: ["#2b6cb0", "#d97706", "#c81e1e", "#8a8a8a"], // tracking, uncertain, lost, not mapped
  accepted: "#0b8043",
  undone: "#d32f2f",
  rejected: "#7c6bd6",
  node: "#34507a",
  place: "#b45309",
  truth: "#111827",
  error: "#e11d48",
  no_go: "#dc2626",
  scans: ["#0b6bcb", "#d6336c"],
  around: "#9ec5ea",
};
const ROOM_COLOURS = ["#2563eb", "#059669", "#d97706", "#7c3aed", "#db2777", "#0891b2", "#65a30d", "#ea580c"];
const TIME_COLOURS = ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21918c", "#28ae80", "#5ec962", "#addc30", "#fde725"];
const SIGMA_COLOURS = ["#1a9850", "#91cf60", "#fee08b", "#fc8d59", "#d73027"]; // of chain edges, the surest first
const ERROR_SCALES = [1, 2, 5, 10, 20, 50, 100];
const LONGEST_ERROR = 0.6; // [m] that the longest error is drawn as, at most
const SIGMA_LIMITS = [0.01, 0.03, 0.1, 0.3]; // [m]
const SIGMA_KEY = ["1 cm or less", "3 cm", "10 cm", "30 cm", "more"];

const stripes = (colours) => (colours.length === 1 ? colours[0] : `linear-gradient(90deg, ${colours.join(", ")})`);

// The map of a run to pan and zoom, with its layers. Metres are Leaflet's plain coordinates: [y, x].
class MapView {
  constructor(place, data) {
    this.data = data;
    this.map = L.map(place, { crs: L.CRS.Simple, minZoom: -6, maxZoom: 9, zoomSnap: 0.25, attributionControl: false, renderer: L.canvas({ tolerance: 4 }) }); // a click need not hit a thin line
    L.control.scale({ imperial: false, maxWidth: 160 }).addTo(this.map);
    this.layers = [];
    this.robot = null;
    this.scans = L.layerGroup().addTo(this.map);
    this.onClosure = () => {};
    this.onNode = () => {};
    this.onTime = () => {};
    this.addGrid();
    this.addRooms();
    this.addTrajectory();
    this.addEdges();
    this.addClosures();
    this.addNodes();
    this.addPlaces();
    this.fit();
    this.addTruth(); // a dashed line can only be added once it is known where the map looks
  }

  // How far a node is drawn from where the map has it, for its part is not tied; not a number: it is not drawn.
  shift(node) {
    const { beside = null } = this.data; // none in a run of an earlier version
    return beside === null || node < 0 ? [0, 0] : [beside.shift[2 * node], beside.shift[2 * node + 1]];
  }

  part(node) {
    const { beside = null } = this.data;
    return beside === null || node < 0 ? -1 : beside.part[node];
  }

  isDrawn(node) {
    return !Number.isNaN(this.shift(node)[0]);
  }

  // Of a sample: the node that carries it, and where it is drawn.
  carrier(sample) {
    const { node } = this.data.samples;
    return node === undefined ? -1 : node[sample];
  }

  samplePoint(sample) {
    const poses = this.data.samples.pose;
    const [dx, dy] = this.shift(this.carrier(sample));
    return [poses[3 * sample + 1] + dy, poses[3 * sample] + dx];
  }

  // Paper shows what the window shows, so many pixels wide.
  print(on, width) {
    const { clientWidth, clientHeight, style } = this.map.getContainer();
    const size = on ? { width: `${clientWidth}px`, height: `${clientHeight}px`, zoom: Math.min(1, width / clientWidth) } : { width: "", height: "", zoom: "" };
    Object.assign(style, size);
  }

  fit() {
    this.map.fitBounds(this.bounds.pad(0.02), { animate: false });
  }

  // A layer with its colours, of which `key` says what each means.
  add(name, colours, layer, on, key = []) {
    this.layers.push({ name, colours: [colours].flat(), layer, on, key });
    if (on) layer.addTo(this.map);
  }

  addGrid() {
    const grid = this.data.grid;
    if (grid === null) {
      const poses = this.data.samples.pose;
      const points = Array.from({ length: poses.length / 3 }, (_, k) => [poses[3 * k + 1], poses[3 * k]]);
      this.bounds = L.latLngBounds(points.length ? points : [[-1, -1], [1, 1]]);
      return;
    }
    const [x, y] = grid.origin;
    this.bounds = L.latLngBounds([[y, x], [y + grid.size[1] * grid.resolution, x + grid.size[0] * grid.resolution]]);
    const image = L.imageOverlay(`data:image/png;base64,${grid.png}`, this.bounds, { className: "grid", alt: "occupancy map" });
    this.add("walls", "#222", image, true);
    const { beside = null } = this.data;
    for (const { text, place } of beside === null ? [] : beside.captions)
      L.tooltip({ permanent: true, direction: "right", className: "label" }).setLatLng([place[1], place[0]]).setContent(element("span", {}, text)).addTo(this.map);
  }

  // Rooms with their areas, and where the robot shall not go; a run of an earlier version has neither.
  addRooms() {
    const corners = (points) => points.map(([x, y]) => [y, x]);
    const shapes = (items, shape) => L.layerGroup(items.map(shape));
    const labelled = (shape, text) => shape.bindTooltip(element("span", {}, text), { permanent: true, direction: "center", className: "label" });
    const { rooms = [], areas = [] } = this.data;
    const room = ({ outline, label }, k) => labelled(L.polygon(corners(outline), { color: ROOM_COLOURS[k % ROOM_COLOURS.length], weight: 1, fillOpacity: 0.25, interactive: false }), label);
    const area = ({ kind, points, name }) => labelled((kind === "no_go_area" ? L.polygon : L.polyline)(corners(points), { color: COLOURS.no_go, weight: 3, interactive: false }), name);
    if (rooms.length) this.add("rooms with their areas", ROOM_COLOURS[0], shapes(rooms, room), false);
    if (areas.length) this.add("areas where the robot shall not go", COLOURS.no_go, shapes(areas, area), true);
  }

  // Runs of consecutive samples with one class each become lines of that class.
  runs(classes, count) {
    const lines = Array.from({ length: count }, () => []);
    let open = false; // whether the line to the sample before can go on
    for (let k = 1; k < classes.length; ++k) {
      const [before, node] = [this.carrier(k - 1), this.carrier(k)];
      if (this.part(before) !== this.part(node) || !this.isDrawn(before) || !this.isDrawn(node)) {
        open = false;
        continue;
      }
      const lists = lines[classes[k]];
      if (open && classes[k] === classes[k - 1]) lists[lists.length - 1].push(this.samplePoint(k));
      else lists.push([this.samplePoint(k - 1), this.samplePoint(k)]);
      open = true;
    }
    return lines;
  }

  coloured(classes, colours) {
    const group = L.layerGroup();
    this.runs(classes, colours.length).forEach((lines, k) => {
      if (!lines.length) return;
      const line = L.polyline(lines, { color: colours[k], weight: 2.5, interactive: true, bubblingMouseEvents: false });
      line.on("click", (event) => this.onTime(this.nearestSample(event.latlng)));
      group.addLayer(line);
    });
    return group;
  }

  addTrajectory() {
    const { state, time } = this.data.samples;
    const seen = COLOURS.states.map((_, code) => code).filter((code) => code === 0 || state.includes(code));
    this.add("trajectory by tracking state", seen.map((code) => COLOURS.states[code]), this.coloured(state, COLOURS.states), true, seen.map((code) => this.data.samples.states[code]));
    const last = time.length ? time[time.length - 1] || 1 : 1;
    const steps = Array.from(time, (t) => Math.min(TIME_COLOURS.length - 1, Math.floor((t / last) * TIME_COLOURS.length)));
    this.add("trajectory by time (dark to light)", TIME_COLOURS, this.coloured(steps, TIME_COLOURS), false);
  }

  nearestSample(latlng) {
    let best = 0, least = Infinity;
    for (let k = 0; k < this.data.samples.time.length; ++k) {
      const [y, x] = this.samplePoint(k);
      const d = (x - latlng.lng) ** 2 + (y - latlng.lat) ** 2;
      if (d < least) [best, least] = [k, d];
    }
    return best;
  }

  point(node) {
    const [x, y] = this.drawnPose(node);
    return [y, x];
  }

  // From node to node; at the first one if they are of different parts; null if that is not drawn.
  line(i, j) {
    return this.isDrawn(i) ? [this.point(i), this.point(this.part(i) === this.part(j) ? j : i)] : null;
  }

  addEdges() {
    const { ends, sigma, kind } = this.data.edges;
    const lines = SIGMA_COLOURS.map(() => []);
    const odometry = [];
    this.follows = new Set(); // nodes that an edge ties to the next one
    for (let k = 0; k < sigma.length; ++k) {
      if (ends[2 * k + 1] === ends[2 * k] + 1) this.follows.add(ends[2 * k]);
      const line = this.line(ends[2 * k], ends[2 * k + 1]);
      if (line === null) continue;
      const above = SIGMA_LIMITS.filter((limit) => sigma[k] > limit).length;
      lines[above].push(line);
      if (kind[k] === 1) odometry.push(line);
    }
    const group = L.layerGroup();
    lines.forEach((part, k) => part.length && group.addLayer(L.polyline(part, { color: SIGMA_COLOURS[k], weight: 4, interactive: false })));
    this.add("chain edges by uncertainty", SIGMA_COLOURS, group, false, SIGMA_KEY);
    if (odometry.length) this.add("chain edges by odometry", "#c026d3", L.polyline(odometry, { color: "#c026d3", weight: 5, interactive: false }), false);
  }

  addClosures() {
    const { ends, verdict, verdicts } = this.data.closures;
    const groups = verdicts.map(() => L.layerGroup());
    for (let k = 0; k < verdict.length; ++k) {
      const colour = verdict[k] === 0 ? COLOURS.accepted : verdict[k] === 1 ? COLOURS.undone : COLOURS.rejected;
      const between = this.line(ends[2 * k], ends[2 * k + 1]);
      if (between === null) continue;
      const line = L.polyline(between, { color: colour, weight: 1.5, opacity: 0.8, bubblingMouseEvents: false });
      line.on("click", () => this.onClosure(k));
      groups[verdict[k]].addLayer(line);
    }
    const rejected = L.layerGroup(groups.slice(2));
    this.add("closures accepted", COLOURS.accepted, groups[0], false);
    this.add("closures undone by the solution", COLOURS.undone, groups[1], true);
    if (groups.length > 2) this.add("attempts rejected", COLOURS.rejected, rejected, false);
  }

  addNodes() {
    const group = L.layerGroup();
    for (let k = 0; k < this.data.nodes.poses.length / 3; ++k) {
      if (!this.isDrawn(k)) continue;
      const dot = L.circleMarker(this.point(k), { radius: 3, weight: 1, color: COLOURS.node, fillOpacity: 0.6, bubblingMouseEvents: false });
      dot.on("click", () => this.onNode(k));
      group.addLayer(dot);
    }
    this.add("nodes (click: the node's scan)", COLOURS.node, group, false);
  }

  addPlaces() {
    if (!this.data.places.length) return;
    const group = L.layerGroup();
    for (const place of this.data.places) {
      const name = element("span", {}, `${place.space}/${place.id}`);
      const icon = L.divIcon({ className: "place", html: name, iconSize: null });
      group.addLayer(L.marker([place.pose[1], place.pose[0]], { icon, keyboard: true, alt: `${place.space}/${place.id}` }));
    }
    this.add("places", COLOURS.place, group, true);
  }

  // The true way, how far each pose is from it, and relations that are off; a run without a truth has none.
  addTruth() {
    const truth = this.data.truth ?? null;
    if (truth === null) return;
    if (truth.true !== null) {
      const poses = this.data.samples.pose, { true: there, off } = truth;
      const known = Array.from(off.keys()).filter((k) => !Number.isNaN(off[k]));
      const at = (k) => [there[2 * k + 1], there[2 * k]];
      this.add("true way", COLOURS.truth, L.polyline(known.map(at), { color: COLOURS.truth, weight: 1.5, dashArray: "4 4", interactive: false }), true);
      const worst = known.reduce((most, k) => Math.max(most, off[k]), 0);
      const times = ERROR_SCALES.findLast((scale) => scale * worst <= LONGEST_ERROR) ?? 1;
      const vector = (k) => [at(k), [0, 1].map((axis) => there[2 * k + 1 - axis] + times * (poses[3 * k + 1 - axis] - there[2 * k + 1 - axis]))];
      this.add(`errors, from the true way, ${times} times as long`, COLOURS.error, L.polyline(known.map(vector), { color: COLOURS.error, weight: 1, interactive: false }), false);
    }
    const { relation_ends: ends, relation_off: off } = truth;
    if (!off.length) return;
    const group = L.layerGroup();
    for (let k = off.length - 1; k >= 0; --k) {
      const above = SIGMA_LIMITS.filter((limit) => off[k] > limit).length;
      const line = [[ends[4 * k + 1], ends[4 * k]], [ends[4 * k + 3], ends[4 * k + 2]]];
      group.addLayer(L.polyline(line, { color: SIGMA_COLOURS[above], weight: 2, interactive: false }));
    }
    this.add(`relations by error, the worst ${off.length} of ${truth.relations}`, SIGMA_COLOURS, group, false, SIGMA_KEY);
  }

  // The points of a node's scan, placed by a pose.
  scanPoints(node, pose) {
    const { points, offsets, step } = this.data.nodes;
    const placed = [];
    for (let k = offsets[node]; k < offsets[node + 1]; ++k) placed.push(Pose.apply(pose, [step * points[2 * k], step * points[2 * k + 1]]));
    return placed;
  }

  nodePose(node) {
    return Pose.at(this.data.nodes.poses, node);
  }

  drawnPose(node) {
    const [x, y, theta] = this.nodePose(node);
    const [dx, dy] = this.shift(node);
    return [x + dx, y + dy, theta];
  }

  // The nodes before and after one that its submap has, without itself.
  around(node) {
    const half = Math.floor((this.data.parameters["loop_closure_graph_builder.submap_neighborhood_size"] ?? 15) / 2);
    const found = [];
    for (const way of [-1, 1])
      for (let k = node + way; Math.abs(k - node) <= half && this.follows.has(way > 0 ? k - 1 : k); k += way) found.push(k);
    return found;
  }

  // Shows scans on the map: a list of [node, pose, colour].
  showScans(scans) {
    this.scans.clearLayers();
    if (scans.some(([, pose]) => pose.some(Number.isNaN))) return; // of a part that is not drawn
    for (const [node, pose, colour] of scans)
      for (const [x, y] of this.scanPoints(node, pose))
        this.scans.addLayer(L.circleMarker([y, x], { radius: 2, stroke: false, fill: true, fillColor: colour, fillOpacity: 0.9, interactive: false }));
    const points = scans.map(([, pose]) => [pose[1], pose[0]]);
    if (points.length > 1) this.scans.addLayer(L.polyline(points, { color: COLOURS.truth, weight: 2, interactive: false }));
    if (points.length && !this.map.getBounds().contains(points)) this.map.fitBounds(L.latLngBounds(points).pad(1), { maxZoom: 5 });
  }

  showRobot(sample) {
    const theta = this.data.samples.pose[3 * sample + 2];
    const [y, x] = this.samplePoint(sample);
    if (Number.isNaN(x)) return;
    if (this.robot === null) {
      const arrow = element("div", { class: "arrow" });
      this.robot = L.marker([y, x], { icon: L.divIcon({ className: "robot", html: arrow, iconSize: [22, 22] }), interactive: false, keyboard: false }).addTo(this.map);
      this.arrow = arrow;
    }
    this.robot.setLatLng([y, x]);
    this.arrow.style.transform = `rotate(${-theta}rad)`;
  }

  // Check boxes for the layers.
  control(place) {
    for (const entry of this.layers) {
      const box = element("input", { type: "checkbox", checked: entry.on });
      box.addEventListener("change", () => (box.checked ? entry.layer.addTo(this.map) : entry.layer.remove()));
      const swatch = entry.key.length ? null : element("i", { style: `background:${stripes(entry.colours)}` });
      place.append(element("label", {}, box, swatch, entry.name));
      if (entry.key.length) place.append(element("p", { class: "key" }, ...entry.key.flatMap((text, k) => [element("span", {}, element("i", { style: `background:${entry.colours[k]}` }), text), " "])));
    }
  }
}
