// Legend of the world panel: for each layer a small picture of what it draws, in its colours and its form.

import { arrow, cased, dots } from "./world_layers.js";
import { faint } from "./world_pixels.js";

/** What is drawn beside the topics, by names. */
export const OVERLAYS = ["grid", "trails", "tf", "names"];

/** Draw what a row of the list shows into its canvas. */
export function legend(canvas, scene, name) {
  const context = canvas.getContext("2d"), entry = scene.layers.get(name), { width, height } = canvas;
  context.clearRect(0, 0, width, height);
  if (entry?.layer.colours) stripes(context, entry.layer.colours, width, height);
  else FORMS[entry?.kind.form ?? name](context, entry?.layer.colour, scene, width, height);
}

const css = (pixel) => `rgba(${pixel & 0xff},${(pixel >> 8) & 0xff},${(pixel >> 16) & 0xff},${(pixel >>> 24) / 255})`;

function stripes(context, colours, width, height) {
  colours.forEach((colour, i) => {
    context.fillStyle = colour;
    context.fillRect((i * width) / colours.length, 0, width / colours.length, height);
  });
}

function line(context, places) {
  context.beginPath();
  for (const place of places) context.lineTo(...place);
}

const FORMS = {
  beams(context, colour, scene, width, height) {
    const ends = [0.2, 0.4, 0.6, 0.8].map((part) => [width - 5, height * part]);
    context.fillStyle = faint(colour, 0.22);
    line(context, [[3, height / 2], ...ends]);
    context.fill();
    dots(context, ends, scene.colours.halo, colour, 1);
  },
  line(context, colour, { colours }, width, height) {
    line(context, [[4, height - 7], [width / 2, height / 2], [width - 4, height / 2]]);
    cased(context, colours, colour, 4);
  },
  ring(context, colour, { colours }, width, height) {
    context.beginPath();
    context.arc(width / 2, height / 2, 6, 0, 2 * Math.PI);
    cased(context, colours, colour, 3);
  },
  area(context, colour, _, width, height) {
    line(context, [[width - 6, 3], [6, height / 2], [width - 6, height - 3]]);
    context.fillStyle = faint(colour, 0.3);
    context.strokeStyle = colour;
    context.lineWidth = 2;
    context.fill();
    context.stroke();
  },
  arrow(context, colour, { colours }, width, height) {
    context.beginPath();
    arrow(context, 7, height / 2, 0, width - 14);
    cased(context, colours, colour, 3);
  },
  cells(context, _, { occupancy }, width, height) { stripes(context, [0, 50, 100].map((value) => css(occupancy[value])), width, height); },
  costs(context, _, { costs }, width, height) { stripes(context, [20, 60, 99, 100].map((value) => css(costs[value])), width, height); },
  heights(context, _, __, width, height) { stripes(context, ["#00f", "#f0f", "#f00"], width, height); },
  grid(context, _, { colours }, width, height) {
    context.strokeStyle = colours.grid;
    context.lineWidth = 2;
    for (const part of [0.25, 0.75]) {
      line(context, [[width * part, 0], [width * part, height]]);
      context.stroke();
      line(context, [[0, height * part], [width, height * part]]);
      context.stroke();
    }
  },
  trails(context, _, scene, width, height) { FORMS.line(context, scene.colours.trail, scene, width, height); },
  tf(context, _, { colours }, width, height) {
    for (const [name, x, y] of [["axis-x", width / 2 + 14, height - 5], ["axis-y", width / 2 - 6, 3]]) {
      line(context, [[width / 2 - 6, height - 5], [x, y]]);
      context.strokeStyle = colours[name];
      context.lineWidth = 3;
      context.stroke();
    }
  },
  names(context, _, scene, width, height) {
    context.font = "16px system-ui";
    context.textAlign = "center";
    context.textBaseline = "middle";
    scene.write(context, "Aa", width / 2, height / 2);
  },
};
