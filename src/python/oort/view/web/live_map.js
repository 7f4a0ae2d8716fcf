// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

const LAYERS = [
  ["walls", "#222", true],
  ["drive", "#2b6cb0", true],
  ["closures", "#0b8043", true],
  ["undone", "#d32f2f", true],
  ["scan", "#d6336c", true],
  ["places", "#b45309", true],
];
const LAYER_NAMES = { drive: "drive", walls: "walls", closures: "closures", undone: "closures undone", scan: "what the robot sees", places: "places" };

// The map as it grows, with the robot. Metres are Leaflet's plain coordinates: [y, x].
class LiveMap {
  constructor(place) {
    this.map = L.map(place, { crs: L.CRS.Simple, minZoom: -6, maxZoom: 9, zoomSnap: 0.25, attributionControl: false, preferCanvas: true });
    L.control.scale({ imperial: false, maxWidth: 160 }).addTo(this.map);
    this.map.setView([0, 0], 5);
    this.bounds = null;
    this.follow = true;
    this.robot = null;
    this.shift = [0, 0]; // of the robot on the drawing, while it drives on a part that is not tied
    this.groups = Object.fromEntries(LAYERS.map(([name, , on]) => [name, on ? L.layerGroup().addTo(this.map) : L.layerGroup()]));
    this.map.on("dragstart", () => this.setFollow(false));
    this.onFollow = () => {};
    this.onPoint = () => {};
    this.map.on("click", (event) => this.onPoint(event.latlng.lng, event.latlng.lat));
  }

  setFollow(on) {
    this.follow = on;
    this.onFollow(on);
  }

  fit() {
    if (this.bounds !== null) this.map.fitBounds(this.bounds.pad(0.05), { animate: false });
  }

  clear() {
    for (const name of ["walls", "drive", "closures", "undone"]) this.groups[name].clearLayers();
    this.bounds = null;
    this.shift = [0, 0];
  }

  // A new drawing: walls and graph.
  show({ grid, nodes, chain, closures, undone, captions, shift }) {
    const first = this.bounds === null;
    this.clear();
    const [x, y] = grid.origin;
    this.bounds = L.latLngBounds([[y, x], [y + grid.size[1] * grid.resolution, x + grid.size[0] * grid.resolution]]);
    this.groups.walls.addLayer(L.imageOverlay(`data:image/png;base64,${grid.png}`, this.bounds, { className: "grid", alt: "occupancy map" }));
    this.shift = shift;
    for (const { text, place } of captions)
      this.groups.walls.addLayer(L.tooltip({ permanent: true, direction: "right", className: "label" }).setLatLng([place[1], place[0]]).setContent(element("span", {}, text)));
    const lines = (ends) => Array.from({ length: ends.length / 2 }, (_, k) => [0, 1].map((side) => [nodes[2 * ends[2 * k + side] + 1], nodes[2 * ends[2 * k + side]]]));
    const draw = (name, ends, style) => ends.length && this.groups[name].addLayer(L.polyline(lines(ends), { interactive: false, ...style }));
    draw("drive", chain, { color: "#2b6cb0", weight: 2.5 });
    draw("closures", closures, { color: "#0b8043", weight: 1.2, opacity: 0.6 });
    draw("undone", undone, { color: "#d32f2f", weight: 1.5 });
    if (first) this.fit();
  }

  showRobot(pose, scan) {
    this.groups.scan.clearLayers();
    if (pose === null) {
      if (this.robot !== null) this.robot.remove();
      this.robot = null;
      return;
    }
    const [dx, dy] = this.shift;
    const [x, y, theta] = [pose[0] + dx, pose[1] + dy, pose[2]];
    if (this.robot === null) {
      this.arrow = element("div", { class: "arrow" });
      const icon = L.divIcon({ className: "robot", html: this.arrow, iconSize: [22, 22] });
      this.robot = L.marker([y, x], { icon, interactive: false, keyboard: false }).addTo(this.map);
    }
    this.robot.setLatLng([y, x]);
    this.arrow.style.transform = `rotate(${-theta}rad)`;
    for (let k = 0; k < scan.length; k += 2)
      this.groups.scan.addLayer(L.circleMarker([scan[k + 1] + dy, scan[k] + dx], { radius: 2, stroke: false, fill: true, fillColor: "#d6336c", fillOpacity: 0.9, interactive: false }));
    if (this.follow && !this.map.getBounds().pad(-0.2).contains([y, x])) this.map.panTo([y, x], { animate: false });
  }

  showPlaces(places, areas) {
    this.groups.places.clearLayers();
    for (const { kind, points } of areas) {
      const corners = points.map(([x, y]) => [y, x]);
      this.groups.places.addLayer((kind === "no_go_area" ? L.polygon : L.polyline)(corners, { color: "#dc2626", weight: 3, interactive: false }));
    }
    for (const { space, id, pose } of places) {
      const icon = L.divIcon({ className: "place", html: element("span", {}, `${space}/${id}`), iconSize: null });
      this.groups.places.addLayer(L.marker([pose[1], pose[0]], { icon, keyboard: true, alt: `${space}/${id}` }));
    }
  }

  // Check boxes for the layers, and one to follow the robot.
  control(place) {
    for (const [name, colour, on] of LAYERS) {
      const box = element("input", { type: "checkbox", checked: on });
      box.addEventListener("change", () => (box.checked ? this.groups[name].addTo(this.map) : this.groups[name].remove()));
      place.append(element("label", {}, box, element("i", { style: `background:${colour}` }), LAYER_NAMES[name]));
    }
    const box = element("input", { type: "checkbox", id: "follow", checked: true });
    box.addEventListener("change", () => (this.follow = box.checked));
    this.onFollow = (on) => (box.checked = on);
    place.append(element("label", {}, box, "follow the robot"));
  }
}
