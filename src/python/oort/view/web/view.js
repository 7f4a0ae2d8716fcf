// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

const $ = (id) => document.getElementById(id);
const milliseconds = (spread) => (spread.p50 === null ? "–" : `P50 ${spread.p50.toFixed(2)}, P99 ${spread.p99.toFixed(2)}, at most ${spread.max.toFixed(1)} ms`);

let view = null; // also for who wants to look into the page from its console

// The page of a live session: states come as they are, a drawing of the map is fetched when there is a newer one.
class LiveView {
  constructor(rows) {
    this.map = new LiveMap($("map"));
    this.map.control($("layers"));
    this.charts = new Charts($("charts"), rows);
    this.calls = null;
    this.drawing = null;
    this.fetching = false;
    this.state = null; // of the drawing that is shown
    this.placed = "";
    $("fit").addEventListener("click", () => this.map.fit());
  }

  update(state) {
    document.title = `Oort: ${state.title}`;
    $("name").textContent = state.title;
    $("status").textContent = `${state.state.replace("_", " ")}: ${state.nodes} nodes, ${state.closures} new closures${state.path ? `, saved at ${state.path}` : ""}`;
    $("tracking").textContent = state.failure ? "mapping ended" : state.tracking;
    $("tracking").className = `badge ${state.failure ? "lost" : state.tracking}`;
    $("failure").textContent = state.failure;
    $("failure").hidden = !state.failure;
    $("progress").hidden = state.progress === null;
    if (state.progress !== null) $("progress").firstElementChild.style.width = `${100 * state.progress}%`;
    this.figures(state);
    this.map.showRobot(state.pose, state.scan);
    this.charts.add(state.sample);
    this.places(state);
    if (state.control && this.calls === null) this.allowCalls();
    if (this.calls !== null) this.calls.update(state.state);
    if (state.drawing !== this.drawing) this.fetchMap(state.drawing);
    else if (state.state === "not_mapping" && this.state !== "not_mapping") this.map.fit(); // the drive is over
    this.state = state.drawing === this.drawing ? state.state : null;
    document.body.dataset.ready = "true";
  }

  figures(state) {
    const [waiting, since] = state.waiting_for_odometry;
    const left_out = Object.entries(state.left_out).map(([reason, count]) => `${reason}: ${count}`);
    if (state.while_paused) left_out.push(`while paused: ${state.while_paused}`);
    const rows = [
      ["scans", `${state.scans[0]} mapped of ${state.scans[1]} that came, ${state.scan_rate.toFixed(1)} a second`],
      ["queue", `${state.queue} in it${waiting ? `, ${waiting} wait for odometry, the first for ${since.toFixed(1)} s` : ""}`],
      ["to map a scan", milliseconds(state.mapping_ms)],
      ["from arrival to pose", milliseconds(state.delay_ms)],
      ["left out", left_out.join("; ") || "none"],
    ];
    $("figures").replaceChildren(...rows.map(([name, value]) => element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, value))));
    const troubles = state.troubles.length ? state.troubles : ["nothing, as far as the scans show"];
    const told = troubles.join("\n");
    if (told !== this.told) $("troubles").replaceChildren(...troubles.map((text) => element("li", {}, text)));
    this.told = told;
  }

  places({ places, areas, control }) {
    const now = JSON.stringify([places, areas]);
    if (now === this.placed) return;
    this.placed = now;
    this.map.showPlaces(places, areas);
    if (!places.length) $("places").replaceChildren(element("li", { class: "key" }, "none"));
    else $("places").replaceChildren(...places.map(({ space, id }) => element("li", {}, `${space}/${id}`, control ? element("button", { type: "button", "aria-label": `Forget ${space}/${id}`, onclick: () => this.forget(space, id) }, "×") : null)));
  }

  forget(space, id) {
    if (confirm(`Forget the place ${space}/${id}?`)) this.calls.make("graph_loc/delete", { space, id });
  }

  allowCalls() {
    this.calls = new Calls($("calls"), $("answer"), $("naming"));
    $("calls").hidden = false;
    this.map.onPoint = (x, y) => this.calls.name([x, y]);
  }

  async fetchMap(revision) {
    if (revision === null) {
      this.map.clear();
      this.drawing = null;
      return;
    }
    if (this.fetching) return;
    this.fetching = true;
    try {
      const response = await fetch("/map");
      if (!response.ok) return;
      const layers = await Data.unpack(await response.json());
      this.map.show(layers);
      this.drawing = layers.revision;
      document.body.dataset.drawing = layers.revision;
    } finally {
      this.fetching = false;
    }
  }
}

function listen() {
  const stream = new WebSocket(`ws://${location.host}/stream`);
  stream.addEventListener("message", (event) => view.update(JSON.parse(event.data)));
  stream.addEventListener("close", () => {
    $("tracking").textContent = "not connected";
    $("tracking").className = "badge gone";
    setTimeout(listen, 2000);
  });
}

async function main() {
  const { samples } = await (await fetch("/samples")).json();
  view = new LiveView(samples);
  listen();
}

main();
