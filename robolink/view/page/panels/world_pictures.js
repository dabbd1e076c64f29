// Pictures made of coloured triangles, as the world node sends signs and the floor's picture.

const MOST = 2048; // pixels of a picture's side
const LEAST = 26; // pixels of a sign on the screen

/** Colour of a std_msgs/ColorRGBA. */
export function css({ r, g, b, a }) { return `rgba(${Math.round(255 * r)},${Math.round(255 * g)},${Math.round(255 * b)},${a})`; }

/**
 * Picture of a marker's triangles in the plane of two of its axes, `u` to the right and `v` up: {canvas, left, top, step}
 * with its upper left corner and the side of a pixel, in metres. Edges are where the pixels' are, where there are few enough.
 */
export function picture({ points, colors, color }, u, v) {
  const us = points.map((each) => each[u]), vs = points.map((each) => each[v]), left = least(us), top = -least(vs.map((each) => -each));
  const wide = -least(us.map((each) => -each)) - left, high = top - least(vs), longest = Math.max(wide, high) || 1;
  const step = Math.max(longest / MOST, Math.min(longest / 64, finest(us, longest), finest(vs, longest)));
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
  canvas.width = Math.max(1, Math.round(wide / step));
  canvas.height = Math.max(1, Math.round(high / step));
  for (let i = 0; i + 2 < points.length; i += 3) {
    context.fillStyle = context.strokeStyle = css(colors[i] ?? color);
    context.lineWidth = 0.5; // or two triangles of one rectangle would have a seam
    context.beginPath();
    for (let k = i; k < i + 3; k++) context.lineTo((us[k] - left) / step, (top - vs[k]) / step);
    context.closePath();
    context.fill();
    context.stroke();
  }
  return { canvas, left, top, step };
}

const least = (values) => values.reduce((a, b) => Math.min(a, b), Infinity);

/** Smallest distance of two values that differ. */
function finest(values, longest) {
  const sorted = [...new Set(values)].sort((a, b) => a - b);
  return sorted.reduce((found, each, i) => (i && each - sorted[i - 1] > longest / MOST ? Math.min(found, each - sorted[i - 1]) : found), longest);
}

/** Draw a sign's plate from above, and its picture before it, facing who looks. */
export function sign(context, { view, colours }, item, at) {
  const { canvas, step } = (item.picture ??= picture(item.marker, "y", "z")), unit = view.ratio;
  const ys = item.marker.points.map(({ y }) => y), low = least(ys), high = -least(ys.map((y) => -y));
  const [x, y] = at({ x: 0, y: 0, z: 0 }), [fx, fy] = at({ x: 1, y: 0, z: 0 }), far = Math.hypot(fx - x, fy - y) || 1;
  const height = Math.max(LEAST * unit, canvas.height * step * view.scale), width = (height * canvas.width) / canvas.height;
  const ahead = Math.max(height, width) / 2 + 5 * unit, px = x + ((fx - x) / far) * ahead, py = y + ((fy - y) / far) * ahead;
  context.lineCap = "butt";
  for (const [colour, wide] of [[colours.halo, 6], [colours.text, 3]]) {
    context.strokeStyle = colour;
    context.lineWidth = wide * unit;
    context.beginPath();
    context.moveTo(...at({ x: 0, y: low, z: 0 }));
    context.lineTo(...at({ x: 0, y: high, z: 0 }));
    context.stroke();
  }
  context.fillStyle = colours.halo;
  context.fillRect(px - width / 2 - unit, py - height / 2 - unit, width + 2 * unit, height + 2 * unit);
  context.imageSmoothingQuality = "high";
  context.drawImage(canvas, px - width / 2, py - height / 2, width, height);
}
