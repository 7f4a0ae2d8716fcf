// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

const CHARTS = [
  ["scans in the queue", [["queue", "#7c3aed", 1]]],
  ["to map a scan, and its delay, over a minute [ms]", [["P50", "#0b6bcb", 2], ["P99", "#0b8043", 3], ["delay P99", "#d97706", 4]]],
  ["share of the returns on the local map", [["inlier ratio", "#0b8043", 5]]],
];
const MOST_ROWS = 3000;

// Rows of the server's samples, the newest last.
class Charts {
  constructor(place, rows) {
    this.rows = rows;
    this.place = place;
    this.charts = CHARTS.map(([title, series]) => new uPlot(this.options(title, series), this.columns(series), place));
    addEventListener("resize", () => this.charts.forEach((chart) => chart.setSize({ width: this.width(), height: 150 })));
  }

  width() {
    return Math.max(200, (this.place.clientWidth - 24) / (this.place.clientWidth > 900 ? 3 : 1));
  }

  options(title, series) {
    const shown = (_, value) => (value === null || value === undefined ? "–" : value.toFixed(2));
    return {
      width: this.width(), height: 150, title, legend: { live: false },
      axes: [{}, { size: 48 }],
      scales: { y: { range: (_, low, high) => [0, Math.max(1, high ?? 1)] } },
      series: [{}, ...series.map(([label, stroke]) => ({ label, stroke, width: 1.5, value: shown }))],
    };
  }

  columns(series) {
    return [this.rows.map((row) => row[0]), ...series.map(([, , column]) => this.rows.map((row) => row[column]))];
  }

  add(row) {
    this.rows.push(row);
    if (this.rows.length > MOST_ROWS) this.rows.shift();
    this.charts.forEach((chart, k) => chart.setData(this.columns(CHARTS[k][1])));
  }
}
