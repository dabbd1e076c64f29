// Pixels of sensor_msgs/Image: the usual encodings as RGBA.

const YUV = { yuv422: [1, 3, 0, 2], uyvy: [1, 3, 0, 2], yuv422_yuy2: [0, 2, 1, 3], yuyv: [0, 2, 1, 3] };
const CHANNELS = { rgb8: [3, 0, 1, 2], bgr8: [3, 2, 1, 0], "8UC3": [3, 2, 1, 0], rgba8: [4, 0, 1, 2, 3], bgra8: [4, 2, 1, 0, 3], "8UC4": [4, 2, 1, 0, 3], mono8: [1, 0, 0, 0], "8UC1": [1, 0, 0, 0] };
const DEEP = { mono16: [2, "getUint16"], "16UC1": [2, "getUint16"], "16SC1": [2, "getInt16"], "32FC1": [4, "getFloat32"], "64FC1": [8, "getFloat64"], "32SC1": [4, "getInt32"] };
const BAYER = { bayer_rggb8: [0, 1, 1, 2], bayer_bggr8: [2, 1, 1, 0], bayer_gbrg8: [1, 2, 0, 1], bayer_grbg8: [1, 0, 2, 1] };

/** Write an image into RGBA pixels (width x height x 4). Throws Error with one line for what cannot be shown. */
export function paint(image, out) {
  const { encoding, width, height, step, data } = image;
  const size = (CHANNELS[encoding]?.[0] ?? DEEP[encoding]?.[0] ?? (YUV[encoding] ? 2 : BAYER[encoding] ? 1 : 0)) * width;
  if (!size) throw new Error(`encoding '${encoding}' is not known`);
  if (step < size || data.length < step * (height - 1) + size) throw new Error(`${width}x${height} ${encoding} with step ${step} has ${data.length} bytes only`);
  if (CHANNELS[encoding]) channels(image, out, CHANNELS[encoding]);
  else if (DEEP[encoding]) deep(image, out, DEEP[encoding]);
  else if (YUV[encoding]) yuv(image, out, YUV[encoding]);
  else bayer(image, out, BAYER[encoding]);
}

function channels({ width, height, step, data }, out, [size, red, green, blue, alpha]) {
  for (let y = 0, to = 0; y < height; y++) {
    for (let x = 0, from = y * step; x < width; x++, from += size, to += 4) {
      out[to] = data[from + red];
      out[to + 1] = data[from + green];
      out[to + 2] = data[from + blue];
      out[to + 3] = alpha === undefined ? 255 : data[from + alpha];
    }
  }
}

/** Grey from the least to the greatest value of the image; what is not a number is dark blue. */
function deep({ width, height, step, data, is_bigendian: big }, out, [size, get]) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength), values = new Float64Array(width * height);
  let low = Infinity, high = -Infinity;
  for (let y = 0, i = 0; y < height; y++) {
    for (let x = 0; x < width; x++, i++) {
      const value = values[i] = view[get](y * step + x * size, !big);
      if (value < low && value > -Infinity) low = value;
      if (value > high && value < Infinity) high = value;
    }
  }
  const scale = 255 / (high - low || 1);
  values.forEach((value, i) => {
    const grey = (value - low) * scale, good = Number.isFinite(value);
    out[4 * i] = out[4 * i + 1] = good ? grey : 0;
    out[4 * i + 2] = good ? grey : 60;
    out[4 * i + 3] = 255;
  });
}

function yuv({ width, height, step, data }, out, [first, second, u, v]) {
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const from = y * step + (x >> 1) * 4, to = (y * width + x) * 4;
      const light = 1.164 * (data[from + (x & 1 ? second : first)] - 16), blue = data[from + u] - 128, red = data[from + v] - 128;
      out[to] = light + 1.596 * red; // a clamped array rounds and bounds it
      out[to + 1] = light - 0.392 * blue - 0.813 * red;
      out[to + 2] = light + 2.017 * blue;
      out[to + 3] = 255;
    }
  }
}

/** Each square of four pixels has one red, two green and one blue: all four get that colour. */
function bayer({ width, height, step, data }, out, pattern) {
  const at = (x, y) => data[Math.min(y, height - 1) * step + Math.min(x, width - 1)];
  for (let y = 0; y < height; y += 2) {
    for (let x = 0; x < width; x += 2) {
      const sum = [0, 0, 0];
      pattern.forEach((colour, i) => { sum[colour] += at(x + (i & 1), y + (i >> 1)); });
      for (let i = 0; i < 4; i++) {
        const px = x + (i & 1), py = y + (i >> 1);
        if (px < width && py < height) out.set([sum[0], sum[1] / 2, sum[2], 255], (py * width + px) * 4);
      }
    }
  }
}
