// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

const MOST_FAULTS = 8; // in sight
const PAPER = 660; // [px] A4 without its margins

function fillTables(data) {
  const row = ([name, value]) => element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, String(value)));
  document.querySelector("#figures").append(...data.figures.map(row));
  const changed = data.changed_parameters.map(({ path, value, default: usual }) => row([path, `${value} (default ${usual})`]));
  document.querySelector("#changed").append(...(changed.length ? changed : [row(["all", "at their defaults"])]));
  document.querySelector("#parameters").append(...Object.entries(data.parameters).map(row));
  const { troubles = [] } = data; // none in a run of an earlier version
  document.querySelector("#troubles").append(...troubles.map(({ text, advice }) => element("li", {}, element("b", {}, `${text}: `), advice)));
  document.querySelector("#wrong").hidden = !troubles.length;
  const faults = data.odometry_faults.first.map((fault) => `odometry ${fault.kind} at ${seconds(fault.time - data.samples.begin)}: ${fault.distance.toFixed(2)} m, ${degrees(fault.angle)}`);
  const items = (texts) => texts.map((text) => element("li", {}, text));
  document.querySelector("#notes").append(...items(data.notes.length || faults.length ? data.notes : ["nothing to note"]));
  if (faults.length > MOST_FAULTS) document.querySelector("#notes").after(element("details", {}, element("summary", {}, `${faults.length} faults of odometry`), element("ul", {}, ...items(faults))));
  else document.querySelector("#notes").append(...items(faults));
}

let view = null; // also for who wants to look into the page from its console

async function main() {
  const data = await Data.load("oort-data");
  document.querySelector("#name").textContent = data.name;
  document.querySelector("#kind").textContent = `${data.kind}, ${seconds(data.recorded_seconds)}, ${data.samples.scans} scans`;
  fillTables(data);
  view = new MapView(document.querySelector("#map"), data);
  view.control(document.querySelector("#layers"));
  document.querySelector("#fit").addEventListener("click", () => view.fit());
  const timeline = new Timeline(document.querySelector("#charts"), document.querySelector("#time"), document.querySelector("#now"), data.samples, data.odometry_faults.first, data.truth);
  const closures = new Closures(view, document.querySelector("#closure-list"), document.querySelector("#verdict"), document.querySelector("#details"), document.querySelector("#overlay"));
  timeline.onTime = (sample) => data.samples.time.length && view.showRobot(sample);
  view.onTime = (sample) => timeline.select(sample);
  view.onClosure = (k) => closures.select(k);
  view.onNode = (node) => closures.showNode(node);
  timeline.begin();
  for (const on of [true, false]) addEventListener(on ? "beforeprint" : "afterprint", () => view.print(on, PAPER));
  document.body.dataset.ready = "true";
}

main().catch((error) => {
  document.querySelector("#name").textContent = `This report cannot be shown: ${error.message}`;
  throw error;
});
