// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

// Buttons for the calls of a session; the server refuses them all unless it was started with --control.
class Calls {
  constructor(place, answer, dialog) {
    Object.assign(this, { answer, dialog, buttons: {} });
    const button = (name, text, press) => place.append((this.buttons[name] = element("button", { type: "button", onclick: press }, text)));
    button("pause", "Pause", () => this.make("map/pause"));
    button("resume", "Resume", () => this.make("map/resume_from_paused"));
    button("docked", "The robot is docked", () => this.make("map/notify_docked"));
    button("name", "Name where the robot is…", () => this.name(null));
    button("stop", "Stop mapping", () => confirm("Stop mapping? The map is then solved, and saved where it has a path.") && this.make("map/stop"));
    place.append(element("p", { class: "key" }, "A click on the map names a point."));
  }

  async make(call, args = {}) {
    this.answer.textContent = "";
    const response = await fetch("/call", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ call, args }) });
    const text = await response.text();
    if (response.ok) return true;
    this.answer.textContent = response.status === 409 ? JSON.parse(text).error : text;
    return false;
  }

  // Asks for a name for where the robot is, or for a point [x, y].
  name(point) {
    const { dialog } = this;
    dialog.querySelector("#where").textContent = point === null ? "Where the robot is now." : `At ${fixed(point[0], 2)} m, ${fixed(point[1], 2)} m.`;
    dialog.querySelector("#id").value = "";
    dialog.returnValue = "";
    dialog.querySelector("#cancel").onclick = () => dialog.close();
    dialog.onclose = () => {
      if (dialog.returnValue !== "ok") return;
      const args = { space: dialog.querySelector("#space").value, id: dialog.querySelector("#id").value };
      if (point === null) this.make("graph_loc/create", args);
      else this.make("graph_loc/create_points", { ...args, x: point[0], y: point[1] });
    };
    dialog.showModal();
    dialog.querySelector("#id").focus();
  }

  update(state) {
    const mapping = state === "mapping", paused = state === "paused";
    Object.entries({ pause: mapping, resume: paused, docked: mapping, name: !paused, stop: mapping || paused }).forEach(([name, on]) => (this.buttons[name].disabled = !on));
  }
}
