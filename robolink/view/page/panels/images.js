// Images panel: the newest image of a topic, raw or compressed (by the browser's own decoders), and how many come.

import { button, download, h } from "../dom.js";
import { addPairs } from "../words.js";
import { Picker } from "./form.js";
import { paint } from "./pixels.js";

addPairs("images", {
  topic: ["topic", "topic"], none: ["no images", "nenhuma imagem"], none_why: ["No topic has images. To see some: robolink launch blobs", "Nenhum topic tem imagens. Para ver algumas: robolink launch blobs"], none_bag: ["No topic of this bag has images.", "Nenhum topic deste bag tem imagens."], waiting: ["no image yet", "nenhuma imagem ainda"],
  save: ["save as PNG", "salvar como PNG"], state: ["{width}x{height}  {encoding}  {fps} fps", "{width}x{height}  {encoding}  {fps} fps"],
});

const TYPES = ["sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"];

/** Panel of pictures; others that show pictures extend it. */
export class Images {
  constructor(element, app, options) {
    Object.assign(this, { element, app, topic: "" }, options);
    this.stamps = [];
    this._build();
    this.off = app.store.on("change", () => this._list());
    this._list();
  }

  save() { return { topic: this.topic }; }

  close() {
    this.off();
    this.handle?.close();
    this.closed = true;
  }

  /** Show a topic's pictures. */
  find(name) {
    this.topic = name;
    this._list();
    this.app.remember();
  }

  _build() {
    const { words } = this.app;
    this.picker = new Picker(words("images.topic"), words("images.none"), (name) => this.find(name));
    this.state = h("p", { class: "dim state" });
    this.canvas = h("canvas", { class: "image", "aria-label": words("panel.images"), width: 1, height: 1, hidden: true });
    this.context = this.canvas.getContext("2d");
    this.hint = h("p", { class: "empty" });
    this.element.append(h("div", { class: "row" }, this.picker.element, this.state, h("span", { class: "gap" }), button("PNG", words("images.save"), () => this.canvas.toBlob((blob) => download("image.png", blob)))), h("div", { class: "paper" }, this.canvas, this.hint));
  }

  /** Names of the topics to choose from. */
  _names() { return this.app.store.list().filter(({ type }) => TYPES.includes(type)).map(({ name }) => name); }

  _list() {
    this.topic = this.picker.show(this._names(), this.topic);
    this.hint.textContent = this.app.words(this.topic ? "images.waiting" : this.app.isBag ? "images.none_bag" : "images.none_why");
    if (!this.topic || this.handle?.topic.name === this.topic) return;
    this.handle?.close();
    this.stamps = [];
    this.seen = null;
    this.canvas.hidden = true;
    this.hint.hidden = false;
    this.state.textContent = "";
    this.handle = this.app.listen(this.topic, { rate: 60, every: () => this.stamps.push(performance.now()) });
  }

  frame(now) {
    const { topic } = this.handle ?? {};
    while (this.stamps[0] < now - 1000) this.stamps.shift();
    if (topic?.view && topic.view !== this.seen && !this.busy) {
      this.seen = topic.view;
      const image = topic.latest;
      if (image) this._show(image, topic.type === TYPES[1]);
      else this._tell(topic.error);
    }
    if (this.shown && !(now - this.told < 250)) this._tell();
  }

  _tell(error) {
    this.told = performance.now();
    if (error) this.shown = null;
    this.state.className = error ? "error state" : "dim state";
    this.state.textContent = error || this.app.words("images.state", { ...this.shown, fps: this.stamps.length });
  }

  async _show(image, isCompressed) {
    try {
      if (isCompressed) await this._compressed(image);
      else this._raw(image);
    } catch (error) {
      this._tell(error.message);
    }
  }

  _size(width, height) {
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    this.canvas.hidden = false;
    this.hint.hidden = true;
  }

  _raw(image) {
    const { width, height, encoding } = image;
    if (!width || !height || width * height > 1e8) throw new Error(`${width}x${height}`);
    if (this.pixels?.width !== width || this.pixels.height !== height) this.pixels = new ImageData(width, height);
    paint(image, this.pixels.data);
    this._size(width, height);
    this.context.putImageData(this.pixels, 0, 0);
    this.shown = { width, height, encoding };
  }

  async _compressed({ format, data }) {
    this.busy = true; // what comes meanwhile is looked at once this one is shown: the newest only
    try {
      const bytes = /compressedDepth/.test(format) ? data.subarray(12) : data; // a header before the PNG
      const picture = await createImageBitmap(new Blob([bytes])).catch(() => { throw new Error(`'${format}': ${data.length} bytes that the browser cannot read`); });
      if (this.closed) return;
      this._size(picture.width, picture.height);
      this.context.drawImage(picture, 0, 0);
      this.shown = { width: picture.width, height: picture.height, encoding: format };
      picture.close();
    } finally {
      this.busy = false;
    }
  }
}

export const panel = { id: "images", create: (element, app, options) => new Images(element, app, options) };
