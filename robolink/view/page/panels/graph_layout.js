// Layout of a graph in layers from left to right: boxes, and edges that run through free lanes between them.

export const HEIGHT = 24; // of a box
const ROW = 34, LANE = 12, GAP = 64, ROUNDS = 8;

/**
 * Place boxes and edges. An item is {key, width, from, to}, with the items that it leads from and to; it gets x and y of
 * its upper left corner. Where an item has `closes`, circles are closed by what leads from it. Returns the edges,
 * {from, to, path}.
 */
export function arrange(items) {
  const columns = layers(items), edges = lanes(items, columns);
  order(columns);
  place(columns);
  for (const edge of edges) edge.path = path(edge.steps, columns);
  return edges;
}

/** Columns of items: each stands right of what leads to it, where there is no circle; what nothing leads to, near its first. */
function layers(items) {
  const stack = [], reached = new Map();
  const isReached = (from, to) => {
    if (!reached.has(from)) {
      const found = new Set([from]);
      for (const each of found) for (const next of each.to) found.add(next);
      reached.set(from, found);
    }
    return reached.get(from).has(to);
  };
  for (const each of items) each.before = each.from.filter((other) => !other.closes || !isReached(each, other));
  for (const root of items) {
    for (stack.push(root); stack.length;) {
      const each = stack.at(-1);
      if (each.layer === undefined) {
        each.layer = -1; // on the way: an edge from here closes a circle
        stack.push(...each.before.filter(({ layer }) => layer === undefined));
      } else {
        if (each.layer < 0) each.layer = each.before.reduce((most, { layer }) => Math.max(most, layer + 1), 0);
        stack.pop();
      }
    }
  }
  for (const each of items) if (!each.from.length && each.to.length) each.layer = Math.max(0, each.to.reduce((least, { layer }) => Math.min(least, layer), Infinity) - 1);
  const columns = [];
  for (const each of items) (columns[each.layer] ??= []).push(each);
  const found = columns.filter(Boolean);
  found.forEach((column, i) => column.forEach((each) => Object.assign(each, { layer: i, left: [], right: [], size: ROW })));
  return found;
}

/** Edges with their steps: an edge to another layer than the next has a lane in each between; those to one item share it. */
function lanes(items, columns) {
  const known = new Map(), edges = [];
  const lane = (to, isBack, layer) => {
    const key = `${isBack} ${layer} ${to.key}`;
    if (!known.has(key)) {
      const made = { layer, left: [], right: [], size: LANE, isLane: true };
      known.set(key, made);
      columns[layer].push(made);
    }
    return known.get(key);
  };
  for (const from of items) {
    for (const to of from.to) {
      const isBack = to.layer <= from.layer, steps = [from];
      if (isBack) for (let layer = from.layer; layer >= to.layer; layer--) steps.push(lane(to, true, layer));
      else for (let layer = from.layer + 1; layer < to.layer; layer++) steps.push(lane(to, false, layer));
      steps.push(to);
      for (let i = 1; i < steps.length; i++) link(steps[i - 1], steps[i]);
      edges.push({ from, to, steps });
    }
  }
  return edges;
}

function link(a, b) {
  if (a.layer < b.layer) { a.right.push(b); b.left.push(a); } else if (a.layer > b.layer) { a.left.push(b); b.right.push(a); } else {
    const [turn, box] = a.isLane ? [a, b] : [b, a];
    turn.beside = [box]; // where it turns round
  }
}

/** Height at which half of the items stand above. */
function median(items) {
  const sorted = items.map(({ middle }) => middle).sort((a, b) => a - b), half = sorted.length >> 1;
  return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

/** Sort each column by where its neighbours stand, to and fro. */
function order(columns) {
  for (let round = 0; round < ROUNDS; round++) {
    for (const column of columns) column.forEach((each, i) => { each.place = (i + 0.5) / column.length; });
    for (const column of round % 2 ? columns : columns.toReversed()) {
      for (const each of column) {
        const near = [...(round % 2 ? each.left : each.right), ...(each.beside ?? [])];
        each.ideal = near.length ? near.reduce((sum, { place: at }) => sum + at, 0) / near.length : each.place;
      }
      column.sort((a, b) => a.ideal - b.ideal);
      column.forEach((each, i) => { each.place = (i + 0.5) / column.length; });
    }
  }
}

/** Give x and y to all. */
function place(columns) {
  for (const column of columns) spread(column, () => 0);
  for (let round = 0; round < ROUNDS; round++) {
    const side = round % 2 ? "left" : "right";
    for (const column of round % 2 ? columns : columns.toReversed()) spread(column, (each) => (each[side].length ? median(each[side]) : each.middle));
  }
  let x = 0;
  for (const column of columns) {
    const width = column.reduce((most, each) => Math.max(most, each.width ?? 0), 0);
    column.start = x;
    column.end = x + width;
    for (const each of column) Object.assign(each, { x: x + (width - each.width) / 2, y: each.middle - HEIGHT / 2 });
    x += width + GAP;
  }
}

/** Place the items of a column, in its order and without overlaps, as near as can be to where each wants to be (isotonic regression). */
function spread(column, wanted) {
  const blocks = [];
  let down = 0;
  column.forEach((each, i) => {
    if (i) down += (column[i - 1].size + each.size) / 2;
    each.down = down;
    const weight = each.isLane ? 3 : 1; // long edges are straight rather than short ones
    blocks.push({ sum: weight * (wanted(each) - down), weight, count: 1 });
    for (let last = blocks.length - 1; last > 0 && blocks[last - 1].sum / blocks[last - 1].weight > blocks[last].sum / blocks[last].weight; last--) {
      const { sum, weight: heavy, count } = blocks.pop(), block = blocks[last - 1];
      Object.assign(block, { sum: block.sum + sum, weight: block.weight + heavy, count: block.count + count });
    }
  });
  let i = 0;
  for (const { sum, weight, count } of blocks) for (const stop = i + count; i < stop; i++) column[i].middle = sum / weight + column[i].down;
}

/** Path of an edge as SVG has it: curves in the gaps between columns, and straight lines through them. */
function path(steps, columns) {
  const [from] = steps, to = steps.at(-1);
  let found = `M${from.x + from.width} ${from.middle}H${columns[from.layer].end}`;
  for (let i = 1; i < steps.length; i++) {
    const a = steps[i - 1], b = steps[i], here = columns[a.layer], there = columns[b.layer];
    const isBack = b.layer < a.layer, isTurn = a.layer === b.layer;
    const x = isTurn ? (b.isLane ? here.end : here.start) : isBack ? here.start : here.end, end = isTurn ? x : isBack ? there.end : there.start;
    const bend = isTurn ? (b.isLane ? GAP / 2 : -GAP / 2) : (end - x) / 2;
    found += `C${x + bend} ${a.middle} ${isTurn ? x + bend : end - bend} ${b.middle} ${end} ${b.middle}`;
    if (b.isLane) found += `H${isTurn || isBack ? there.start : there.end}`;
  }
  return `${found}H${to.x}`;
}
