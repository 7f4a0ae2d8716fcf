// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

const PAPER = 660; // [px] A4 without its margins
const RUN_COLOURS = ["#0b6bcb", "#d6336c"];

// One map per run, or the second's walls and trajectory on the first's.
class Pair {
  constructor(runs) {
    const places = ["#map-a", "#map-b"].map((id) => document.querySelector(id));
    this.views = runs.map((run, k) => new MapView(places[k], run));
    this.pair = document.querySelector("#pair");
    this.over = this.overlay(runs[1]);
    this.follow();
    for (const radio of document.querySelectorAll("[name=mode]")) radio.addEventListener("change", () => this.show(radio.value));
    document.querySelector("#share").addEventListener("input", (event) => this.share(event.target.value / 100));
    this.share(0.5);
  }

  overlay(run) {
    const group = L.layerGroup();
    const grid = run.grid;
    if (grid !== null) {
      const bounds = this.views[1].bounds;
      this.image = L.imageOverlay(`data:image/png;base64,${grid.png}`, bounds, { className: "grid over", alt: "occupancy map of the second run" });
      group.addLayer(this.image);
    }
    this.ways = this.views.map((view, k) => {
      const poses = view.data.samples.pose;
      const line = Array.from({ length: poses.length / 3 }, (_, n) => [poses[3 * n + 1], poses[3 * n]]);
      return L.polyline(line, { color: RUN_COLOURS[k], weight: 2, interactive: false });
    });
    this.ways.forEach((way) => group.addLayer(way));
    return group;
  }

  // Both maps show the same place.
  follow() {
    let busy = false;
    const [a, b] = this.views.map((view) => view.map);
    for (const [from, to] of [[a, b], [b, a]])
      from.on("move zoom", () => {
        if (busy) return;
        busy = true;
        to.setView(from.getCenter(), from.getZoom(), { animate: false });
        busy = false;
      });
    b.setView(a.getCenter(), a.getZoom(), { animate: false });
  }

  share(value) {
    if (this.image) this.image.setOpacity(value);
  }

  show(mode) {
    this.pair.classList.toggle("one", mode === "over");
    const { map, layers } = this.views[0];
    for (const { name, layer, on } of layers) if (on && name !== "walls") mode === "over" ? layer.remove() : layer.addTo(map);
    if (mode === "over") this.over.addTo(map);
    else this.over.remove();
    this.views.forEach((view) => view.map.invalidateSize());
    this.views[0].fit();
  }
}

function fillTable(id, names, rows) {
  const cells = (tag, values) => values.map((value) => element(tag, {}, value === null || value === undefined ? "–" : String(value)));
  const head = element("tr", {}, ...cells("th", ["", ...names]));
  const body = rows.map(([name, a, b]) => element("tr", { class: a !== b ? "differs" : "" }, element("th", { scope: "row" }, name), ...cells("td", [a, b])));
  document.querySelector(id).append(head, ...body);
}

function showApart({ time, distance }) {
  if (!time.length) {
    document.querySelector("#apart-section").hidden = true;
    return;
  }
  const mean = distance.reduce((sum, value) => sum + value, 0) / distance.length;
  const most = distance.reduce((a, b) => Math.max(a, b), 0);
  document.querySelector("#apart-text").textContent = `Mean ${mean.toFixed(3)} m, at most ${most.toFixed(3)} m; at the same times, maps not aligned.`;
  const place = document.querySelector("#apart");
  const options = { width: place.clientWidth, height: 160, scales: { x: { time: false } }, axes: [{ values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, { size: 56 }], series: [{ label: "time", value: (_, v) => (v === null ? "–" : seconds(v)) }, { label: "apart", stroke: "#0b6bcb", value: (_, v) => (v === null || v === undefined ? "–" : `${v.toFixed(3)} m`) }] };
  new uPlot(options, [Array.from(time), Array.from(distance)], place);
}

async function main() {
  const data = await Data.load("oort-data");
  document.querySelector("#name").textContent = `${data.names[0]} and ${data.names[1]}`;
  document.querySelector("#kind").textContent = data.runs.map((run) => `${run.name}: ${run.kind}, ${run.samples.scans} scans`).join("; ");
  const sides = ["left", "right"].flatMap((side, k) => [element("i", { style: `background:${RUN_COLOURS[k]}` }), `${data.names[k]} (${side}) `]);
  document.querySelector("#runs").append(...sides);
  const one = () => document.querySelector("#pair").classList.contains("one");
  const { views } = new Pair(data.runs);
  for (const on of [true, false]) addEventListener(on ? "beforeprint" : "afterprint", () => views.forEach((view) => view.print(on, one() ? PAPER : PAPER / 2 - 10)));
  showApart(data.apart);
  fillTable("#figures", data.names, data.figures);
  fillTable("#parameters", data.names, data.parameters.length ? data.parameters : [["none", "", ""]]);
  document.body.dataset.ready = "true";
}

main().catch((error) => {
  document.querySelector("#name").textContent = `This page cannot be shown: ${error.message}`;
  throw error;
});
