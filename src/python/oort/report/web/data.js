// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
"use strict";

// Unpacks the data of the page: arrays come as little-endian bytes, zlib, base64 (oort/report/arrays.py).
const Data = {
  types: { f4: Float32Array, i4: Int32Array, i2: Int16Array, u1: Uint8Array },

  async array(packed) {
    const text = atob(packed.data);
    const bytes = new Uint8Array(text.length);
    for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k); // Uint8Array.from() takes seconds for a long drive
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Data.types[packed.type](await new Response(stream).arrayBuffer());
  },

  async unpack(value) {
    if (Array.isArray(value)) return Promise.all(value.map(Data.unpack));
    if (value === null || typeof value !== "object") return value;
    if ("type" in value && "shape" in value && "data" in value) return Data.array(value);
    const entries = Object.entries(value).map(async ([key, inner]) => [key, await Data.unpack(inner)]);
    return Object.fromEntries(await Promise.all(entries));
  },

  load(id) {
    return Data.unpack(JSON.parse(document.getElementById(id).textContent));
  },
};

// Planar poses as [x, y, theta]; T_a_b takes points of frame b to frame a.
const Pose = {
  at: (array, k) => [array[3 * k], array[3 * k + 1], array[3 * k + 2]],
  apply: ([x, y, theta], [px, py]) => {
    const c = Math.cos(theta), s = Math.sin(theta);
    return [x + c * px - s * py, y + s * px + c * py];
  },
  between: ([x, y, theta], b) => [...Pose.apply([0, 0, -theta], [b[0] - x, b[1] - y]), b[2] - theta],
  compose: (a, b) => [...Pose.apply(a, b), a[2] + b[2]],
};

// An element with attributes, and children that are elements or texts (never markup: names come from outside).
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value !== false) made.setAttribute(name, value === true ? "" : value);
  }
  made.append(...children.filter((child) => child !== null));
  return made;
}

const seconds = (value) => (value < 120 ? `${value.toFixed(1)} s` : `${Math.floor(value / 60)} min ${Math.floor(value % 60)} s`);
const fixed = (value, digits) => value.toFixed(digits).replace(/^-(0\.0+)$/, "$1"); // no -0.00
const degrees = (radians) => `${fixed((radians * 180) / Math.PI, 2)}°`;
