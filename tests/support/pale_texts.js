// How many texts the page shows, and those that are too pale for what is behind them, with element and contrast.
(() => {
  const context = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const rgba = (colour) => {
    context.clearRect(0, 0, 1, 1);
    context.fillStyle = colour;
    context.fillRect(0, 0, 1, 1);
    return [...context.getImageData(0, 0, 1, 1).data].map((each) => each / 255);
  };
  const over = ([r, g, b, a], below) => [r, g, b].map((each, i) => each * a + below[i] * (1 - a));
  const ground = (element) => {
    const layers = [];
    for (let each = element; each; each = each.parentElement) {
      layers.push(rgba(getComputedStyle(each).backgroundColor));
      if (layers.at(-1)[3] > 0.99) break;
    }
    return layers.reverse().reduce((below, each) => over(each, below), [1, 1, 1]);
  };
  const opacity = (element) => {
    let found = 1;
    for (let each = element; each; each = each.parentElement) found *= Number(getComputedStyle(each).opacity);
    return found;
  };
  const light = (colour) => colour.map((each) => (each <= 0.04045 ? each / 12.92 : ((each + 0.055) / 1.055) ** 2.4))
    .reduce((sum, each, i) => sum + each * [0.2126, 0.7152, 0.0722][i], 0);
  const contrast = (one, other) => {
    const [low, high] = [light(one), light(other)].sort((a, b) => a - b);
    return (high + 0.05) / (low + 0.05);
  };
  const pale = [];
  let count = 0;
  const judge = (element, text, colour, behind) => {
    if (!text.trim() || !element.checkVisibility({ visibilityProperty: true, opacityProperty: true }) || element.closest(":disabled, [aria-disabled=true]")) return;
    count += 1;
    const style = getComputedStyle(element), size = parseFloat(style.fontSize), below = behind ?? ground(element);
    const [r, g, b, a] = rgba(colour), is_large = size >= 24 || (size >= 18.66 && style.fontWeight >= 700);
    const found = contrast(over([r, g, b, a * opacity(element)], below), below);
    if (found < (is_large ? 3 : 4.5)) pale.push(`${text.trim().slice(0, 40)} <${element.tagName} ${element.id} ${element.getAttribute("class")}> ${found.toFixed(2)}`);
  };
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement, style = getComputedStyle(element);
    if (element.matches("option, script, style, noscript, noscript *")) continue;
    const box = element.closest("svg.graph g")?.querySelector("rect");
    if (element.tagName === "text") judge(element, node.data, style.fill, box && rgba(getComputedStyle(box).fill).slice(0, 3));
    else judge(element, node.data, style.color);
  }
  for (const each of document.querySelectorAll("input, select, textarea")) {
    const text = each.tagName === "SELECT" ? each.selectedOptions[0]?.text ?? "" : /^(range|checkbox)$/.test(each.type) ? "" : each.value;
    judge(each, text, getComputedStyle(each).color);
    if (!each.value && each.placeholder) judge(each, each.placeholder, getComputedStyle(each, "::placeholder").color);
  }
  return [count, [...new Set(pale)]];
})();
