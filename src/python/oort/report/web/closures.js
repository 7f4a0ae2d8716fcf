// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

// The list of closures, and what is known of the one selected: two scans laid over each other and why it was decided so.
class Closures {
  constructor(view, list, filter, details, canvas) {
    Object.assign(this, { view, list, filter, details, canvas, data: view.data.closures });
    const { verdicts, verdict } = this.data;
    verdicts.forEach((name, code) => {
      const count = verdict.filter((value) => value === code).length;
      if (count) filter.append(element("option", { value: code }, `${code > 1 ? "rejected: " : ""}${name} (${count})`));
    });
    filter.addEventListener("change", () => this.fill());
    list.addEventListener("change", () => this.show(Number(list.value)));
    this.fill();
  }

  fill() {
    const code = Number(this.filter.value);
    const { ends, verdict, moved } = this.data;
    const found = [];
    for (let k = 0; k < verdict.length; ++k) if (verdict[k] === code) found.push(k);
    found.sort((a, b) => moved[2 * b] - moved[2 * a]);
    const options = found.map((k) => element("option", { value: k }, `${ends[2 * k + 1]} on ${ends[2 * k]}: ${(100 * moved[2 * k]).toFixed(1)} cm, ${degrees(moved[2 * k + 1])} off`));
    this.list.replaceChildren(...options);
  }

  select(k) {
    this.filter.value = this.data.verdict[k];
    this.fill();
    this.list.value = k;
    this.show(k);
  }

  reason(k) {
    const { verdict, verdicts, moved, switch: switches } = this.data;
    const off = `${(100 * moved[2 * k]).toFixed(1)} cm and ${degrees(moved[2 * k + 1])}`;
    if (verdict[k] === 0) return `Accepted, and kept by the solution (switch ${switches[k].toFixed(2)}): the map has it within ${off} of where the scans match.`;
    if (verdict[k] === 1) return `Accepted at first, then switched off by the solution (switch ${switches[k].toFixed(2)}): the rest of the map has it ${off} from where the scans match.`;
    return `Rejected: ${verdicts[verdict[k]]}. The map has it ${off} from where the attempt put it.`;
  }

  show(k) {
    const { ends, pose, inlier_ratio } = this.data;
    const [base, moving] = [ends[2 * k], ends[2 * k + 1]];
    const measured = Pose.at(pose, k);
    const ratio = Number.isNaN(inlier_ratio[k]) ? "unknown" : inlier_ratio[k].toFixed(3);
    this.details.replaceChildren(
      element("h3", {}, `Node ${moving} on node ${base}`),
      element("p", {}, this.reason(k)),
      element("p", {}, `Inlier ratio ${ratio}; measured ${fixed(measured[0], 3)} m, ${fixed(measured[1], 3)} m, ${degrees(measured[2])}.`),
      element("p", { class: "key" }, element("i", { style: `background:${COLOURS.scans[0]}` }), `scan of node ${base} `, element("i", { style: `background:${COLOURS.around}` }), "of the nodes around it ", element("i", { style: `background:${COLOURS.scans[1]}` }), `scan of node ${moving} where the match put it`),
    );
    this.draw(base, moving, measured);
    const origin = this.view.drawnPose(base);
    this.view.showScans([[base, origin, COLOURS.scans[0]], [moving, Pose.compose(origin, measured), COLOURS.scans[1]]]);
  }

  showNode(node) {
    const [x, y, theta] = this.view.nodePose(node);
    this.details.replaceChildren(element("h3", {}, `Node ${node}`), element("p", {}, `At ${fixed(x, 3)} m, ${fixed(y, 3)} m, ${degrees(theta)}.`));
    this.draw(node, null, null);
    this.view.showScans([[node, this.view.drawnPose(node), COLOURS.scans[0]]]);
  }

  // Both scans in the frame of the first, and what else its submap has, as the map has it.
  draw(base, moving, measured) {
    const context = this.canvas.getContext("2d");
    const { width, height } = this.canvas;
    const clouds = [[this.view.scanPoints(base, [0, 0, 0]), COLOURS.scans[0]]];
    if (moving !== null) {
      const around = (node) => this.view.scanPoints(node, Pose.between(this.view.nodePose(base), this.view.nodePose(node)));
      clouds.unshift([this.view.around(base).flatMap(around), COLOURS.around]);
      clouds.push([this.view.scanPoints(moving, measured), COLOURS.scans[1]]);
    }
    const all = clouds.flatMap(([points]) => points);
    context.clearRect(0, 0, width, height);
    if (!all.length) return;
    const [xs, ys] = [all.map((p) => p[0]), all.map((p) => p[1])];
    const [left, right, low, high] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    const scale = 0.92 * Math.min(width / Math.max(1, right - left), height / Math.max(1, high - low));
    clouds.forEach(([points, colour]) => {
      context.fillStyle = colour;
      for (const [x, y] of points) context.fillRect(width / 2 + scale * (x - (left + right) / 2) - 1.5, height / 2 - scale * (y - (low + high) / 2) - 1.5, 3, 3);
    });
    this.canvas.hidden = false;
  }
}
