// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

const PAPER = 660; // [px] A4 without its margins
const RUN_COLOURS = ["#0072b2", "#d55e00"]; // Okabe and Ito's blue and vermilion: one on the other is nearly black
const BOTH_COLOUR = "#002a00"; // that product
const WALL = 100, FREE = 250; // grey values below and above

// A map with its walls in a colour, on white.
async function coloured(png, colour) {
  const image = new Image();
  image.src = `data:image/png;base64,${png}`;
  await image.decode();
  const canvas = element("canvas", { width: image.width, height: image.height });
  const context = canvas.getContext("2d");
  context.drawImage(image, 0, 0);
  const pixels = context.getImageData(0, 0, image.width, image.height);
  const wall = [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
  for (let k = 0; k < pixels.data.length; k += 4) {
    const grey = pixels.data[k];
    pixels.data.set(grey < WALL ? wall : grey > FREE ? [255, 255, 255] : [236, 236, 236], k);
  }
  context.putImageData(pixels, 0, 0);
  return canvas.toDataURL();
}

// One map per run, or the walls and trajectories of both on one: where walls agree their colours make a dark one.
class Pair {
  constructor(runs) {
    const places = ["#map-a", "#map-b"].map((id) => document.querySelector(id));
    this.views = runs.map((run, k) => new MapView(places[k], run));
    this.pair = document.querySelector("#pair");
    this.over = null; // made when it is first shown
    this.follow();
    for (const radio of document.querySelectorAll("[name=mode]")) radio.addEventListener("change", () => this.show(radio.value));
    document.querySelector("#share").addEventListener("input", (event) => this.share(event.target.value / 100));
  }

  async overlay() {
    const group = L.layerGroup();
    this.images = [];
    for (const [k, { data, bounds }] of this.views.entries()) {
      if (data.grid === null) continue;
      const alt = `occupancy map of the ${["first", "second"][k]} run`;
      this.images[k] = L.imageOverlay(await coloured(data.grid.png, RUN_COLOURS[k]), bounds, { className: "grid over", alt });
      group.addLayer(this.images[k]);
    }
    this.views.forEach(({ data }, k) => {
      const poses = data.samples.pose;
      const line = Array.from({ length: poses.length / 3 }, (_, n) => [poses[3 * n + 1], poses[3 * n]]);
      group.addLayer(L.polyline(line, { color: RUN_COLOURS[k], weight: 1, interactive: false }));
    });
    this.share(this.value);
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

  // In the middle both are whole, at an end there is one of them.
  share(value) {
    this.value = value;
    [1 - value, value].forEach((part, k) => this.images?.[k]?.setOpacity(Math.min(1, 2 * part)));
  }

  async show(mode) {
    if (mode === "over") this.over ??= await this.overlay();
    if (mode !== document.querySelector("[name=mode]:checked").value) return; // the other was chosen meanwhile
    this.pair.classList.toggle("one", mode === "over");
    for (const key of document.querySelectorAll("[data-mode]")) key.hidden = key.dataset.mode !== mode;
    const { map, layers } = this.views[0];
    for (const { layer, on } of layers) if (on) mode === "over" ? layer.remove() : layer.addTo(map);
    if (mode === "over") this.over.addTo(map);
    else this.over?.remove();
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
  const options = { width: place.clientWidth, height: 160, scales: { x: { time: false } }, axes: [{ values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, { size: 64, values: (_, ticks) => ticks.map((tick) => `${tick} m`) }], series: [{ label: "time", value: (_, v) => (v === null ? "–" : seconds(v)) }, { label: "apart", stroke: "#0b6bcb", value: (_, v) => (v === null || v === undefined ? "–" : `${v.toFixed(3)} m`) }] };
  new uPlot(options, [Array.from(time), Array.from(distance)], place);
}

async function main() {
  const data = await Data.load("oort-data");
  document.querySelector("#name").textContent = `${data.names[0]} and ${data.names[1]}`;
  document.querySelector("#kind").textContent = data.runs.map((run, k) => `${data.names[k]}: ${run.name}, ${run.kind}, ${run.samples.scans} scans`).join("; ");
  const walls = [...RUN_COLOURS, BOTH_COLOUR].flatMap((colour, k) => [element("i", { style: `background:${colour}` }), `${data.names[k] ?? "both"} `]);
  document.querySelector("#walls").append("walls of ", ...walls);
  const one = () => document.querySelector("#pair").classList.contains("one");
  const { views } = new Pair(data.runs);
  const shown = new Map(views.flatMap(({ layers }) => layers.filter(({ on }) => on).map(({ name, colours }) => [name, colours])));
  const key = Array.from(shown).flatMap(([name, colours]) => [element("i", { style: `background:${stripes(colours)}` }), `${name} `]);
  document.querySelector("#runs").append(`left ${data.names[0]}, right ${data.names[1]}: `, ...key);
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
