// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

// Charts over time with one cursor, linked with a slider; onTime is told of the sample under the cursor.
class Timeline {
  constructor(place, slider, output, samples, faults, truth = null) {
    Object.assign(this, { samples, slider, output, faults, truth, charts: [], onTime: () => {} });
    const count = samples.time.length;
    slider.max = Math.max(0, count - 1);
    slider.addEventListener("input", () => this.select(Number(slider.value)));
    const x = Array.from(samples.time);
    const plain = (values) => Array.from(values, (value) => (Number.isNaN(value) ? null : value));
    this.chart(place, "local SLAM and waiting for global SLAM [ms per scan]", [x, plain(samples.local_ms), plain(samples.waited_ms)], [
      { label: "local", stroke: "#0b6bcb", width: 1, value: (_, v) => (v === null ? "–" : v.toFixed(2)) },
      { label: "waited", stroke: "#d97706", width: 1, value: (_, v) => (v === null ? "–" : v.toFixed(2)) },
    ]);
    this.chart(place, "share of the returns on the local map (inlier ratio)", [x, plain(samples.inlier_ratio)], [
      { label: "inlier ratio", stroke: "#0b8043", width: 1, value: (_, v) => (v === null ? "–" : v.toFixed(3)) },
    ], [0, 1]);
    const { way_scale, turn_scale } = samples; // none in a run of an earlier version
    if (way_scale !== undefined && way_scale.some((value) => !Number.isNaN(value))) {
      const factor = (_, v) => (v === null ? "–" : v.toFixed(3));
      this.chart(place, "how far the base drives and turns where odometry says 1, as learned", [x, plain(way_scale), plain(turn_scale)], [
        { label: "drives", stroke: "#7c3aed", width: 1.5, value: factor },
        { label: "turns", stroke: "#0891b2", width: 1.5, value: factor },
      ], (_, low, high) => [Math.min(0.95, low ?? 1), Math.max(1.05, high ?? 1)]);
    }
    if (truth !== null && truth.off !== null) {
      this.chart(place, "off the truth [m]", [x, plain(truth.off)], [
        { label: "off", stroke: "#e11d48", width: 1, value: (_, v) => (v === null ? "–" : `${v.toFixed(4)} m`) },
      ]);
    }
    if (truth !== null && truth.relation_off_at !== null) {
      this.chart(place, "error of the relations that end there, the worst [m]", [x, plain(truth.relation_off_at)], [
        { label: "error", stroke: "#e11d48", width: 0, points: { show: true, size: 4 }, value: (_, v) => (v === null ? "–" : `${v.toFixed(3)} m`) },
      ]);
    }
    addEventListener("resize", () => this.charts.forEach((chart) => chart.setSize({ width: place.clientWidth, height: 150 })));
  }

  chart(place, title, data, series, range = null) {
    const options = {
      width: place.clientWidth, height: 150, title,
      cursor: { sync: { key: "oort" }, drag: { x: true, y: false } },
      scales: { x: { time: false }, y: range === null ? {} : { range } },
      axes: [{ values: (_, ticks) => ticks.map((tick) => `${tick} s`) }, { size: 56 }],
      series: [{ label: "time", value: (_, v) => (v === null ? "–" : seconds(v)) }, ...series],
      hooks: { drawClear: [(u) => this.drawStates(u)], setCursor: [(u) => this.moved(u)] },
    };
    this.charts.push(new uPlot(options, data, place));
  }

  // Behind the curves: stretches that were not tracking, and odometry's faults.
  drawStates(u) {
    const { time, state } = this.samples;
    const { left, top, width, height } = u.bbox;
    u.ctx.save();
    u.ctx.beginPath();
    u.ctx.rect(left, top, width, height);
    u.ctx.clip();
    for (let k = 0; k < time.length; ) {
      let end = k + 1;
      while (end < time.length && state[end] === state[k]) ++end;
      if (state[k] !== 0) {
        const from = u.valToPos(time[k], "x", true), to = u.valToPos(time[Math.min(end, time.length - 1)], "x", true);
        u.ctx.fillStyle = `${COLOURS.states[state[k]]}40`;
        u.ctx.fillRect(from, top, Math.max(2, to - from), height);
      }
      k = end;
    }
    u.ctx.fillStyle = "#9d174d";
    for (const fault of this.faults) u.ctx.fillRect(u.valToPos(fault.time - this.samples.begin, "x", true) - 1, top, 2, height);
    u.ctx.restore();
  }

  moved(u) {
    if (u.cursor.idx === null || u.cursor.idx === undefined || !u.cursor.event) return; // moved by the script, not by hand
    this.tell(u.cursor.idx);
  }

  select(sample) {
    for (const chart of this.charts) {
      const { time } = this.samples;
      const left = chart.valToPos(time[sample], "x");
      chart.setCursor({ left, top: 40 }, false);
    }
    this.tell(sample);
  }

  // Before anybody has moved along it.
  begin() {
    if (this.samples.time.length) this.output.textContent = "move along the charts, or by the arrow keys here";
  }

  tell(sample) {
    const { time, state, states, inlier_ratio } = this.samples;
    this.slider.value = sample;
    const ratio = Number.isNaN(inlier_ratio[sample]) ? "not matched" : `inlier ratio ${inlier_ratio[sample].toFixed(3)}`;
    const off = this.truth?.off ?? null;
    const told = off === null || Number.isNaN(off[sample]) ? "" : `, ${off[sample].toFixed(3)} m and ${this.truth.turned[sample].toFixed(2)}° off the truth`;
    this.output.textContent = time.length ? `${seconds(time[sample])}: ${states[state[sample]]}, ${ratio}${told}` : "no scan";
    this.onTime(sample);
  }
}
