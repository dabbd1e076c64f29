// Legend of the world panel: for each layer a small picture of what it draws, in its colours and its form.

import { arrow, cased, dots } from "./world_layers.js";
import { faint } from "./world_pixels.js";

/** What is drawn beside the topics, by names. */
export const OVERLAYS = ["grid", "trails", "tf", "names"];

const WIDTH = 44, HEIGHT = 24, MIDDLE = HEIGHT / 2;

/** Draw what a row of the list shows into its canvas of 44 by 24 pixels. */
export function legend(canvas, scene, name) {
  const context = canvas.getContext("2d"), { layer, kind } = scene.layers.get(name) ?? {}, { colours } = scene;
  context.clearRect(0, 0, WIDTH, HEIGHT);
  if (layer?.colours) {
    layer.colours.forEach((colour, i, all) => {
      context.fillStyle = colour;
      context.fillRect((i * WIDTH) / all.length, 0, WIDTH / all.length, HEIGHT);
    });
  } else FORMS[kind?.form ?? name]?.(context, layer?.colour ?? colours.trail, scene);
}

function line(context, ...places) {
  context.beginPath();
  for (const place of places) context.lineTo(...place);
}

const FORMS = {
  beams(context, colour, { colours }) {
    const ends = [5, 10, 14, 19].map((y) => [39, y]);
    context.fillStyle = faint(colour, 0.22);
    line(context, [3, MIDDLE], ...ends);
    context.fill();
    dots(context, ends, colours.halo, colour, 1);
  },
  line(context, colour, { colours }) {
    line(context, [4, 17], [22, MIDDLE], [40, MIDDLE]);
    cased(context, colours, colour, 4);
  },
  ring(context, colour, { colours }) {
    context.beginPath();
    context.arc(22, MIDDLE, 6, 0, 7);
    cased(context, colours, colour, 3);
  },
  area(context, colour) {
    line(context, [38, 3], [6, MIDDLE], [38, 21]);
    context.fillStyle = faint(colour, 0.22);
    context.fill();
    context.strokeStyle = colour;
    context.lineWidth = 2;
    context.stroke();
  },
  arrow(context, colour, { colours }) {
    context.beginPath();
    arrow(context, 7, MIDDLE, 0, 30);
    cased(context, colours, colour, 3);
  },
  tf(context, _, { colours }, names = ["axis-x", "axis-y"]) {
    names.forEach((name, i) => {
      line(context, [16, 19], i ? [16, 3] : [36, 19]);
      context.strokeStyle = colours[name];
      context.lineWidth = 3;
      context.stroke();
    });
  },
  grid(context, _, scene) { FORMS.tf(context, _, scene, ["grid", "grid"]); },
  names(context, _, scene) {
    context.font = "16px system-ui";
    context.textAlign = "center";
    scene.write(context, "Aa", 22, 18);
  },
};
FORMS.trails = FORMS.line;
