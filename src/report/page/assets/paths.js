
// ---- the paths: references, band of the simulated ones, the worst, and those that are lit ----

const svgName = 'http://www.w3.org/2000/svg';
const pathPlace = document.getElementById('paths');
const decoded = new Map();
let lightRows = () => {};

function points(steps) {
  if (decoded.has(steps)) return decoded.get(steps);
  const list = [];
  let x = 0, y = 0;
  for (let i = 0; i + 1 < steps.length; i += 2) {
    x += steps[i];
    y += steps[i + 1];
    list.push([x * page.paths.unit_m, y * page.paths.unit_m]);
  }
  decoded.set(steps, list);
  return list;
}

function element(name, attributes, ...children) {
  const made = document.createElementNS(svgName, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function at(path, u) {
  const place = u * (path.length - 1), i = Math.min(Math.floor(place), path.length - 2), f = place - i;
  return [0, 1].map(k => path[i][k] * (1 - f) + path[i + 1][k] * f);
}

// A round length of at most a third of the width.
function roundLength(limit) {
  const decade = 10 ** Math.floor(Math.log10(limit));
  return [5, 2, 1].map(n => n * decade).find(length => length <= limit) ?? decade;
}

// Metres to pixels at one scale for both axes.
function frame(paths, wide, most) {
  const xs = paths.flat().map(p => p[0]), ys = paths.flat().map(p => p[1]);
  const [x0, x1] = [Math.min(...xs), Math.max(...xs)], [y0, y1] = [Math.min(...ys), Math.max(...ys)];
  const edge = 26, length = Math.max(x1 - x0, 1e-3), breadth = Math.max(y1 - y0, 0.25 * length);
  const scale = Math.min((wide - 2 * edge) / length, (most - 2 * edge) / breadth);
  const high = Math.round(breadth * scale + 2 * edge);
  const left = (wide - (x0 + x1) * scale) / 2, foot = (high + (y0 + y1) * scale) / 2;
  return { scale, high, to: ([x, y]) => [left + x * scale, foot - y * scale] };
}

function drawPaths(k) {
  if (!pathPlace) return;
  const { paths } = page, view = paths.views[k];
  const references = view.references.map(i => paths.references[i]);
  const worst = paths.rows[view.worst], band = view.band && points(view.band);
  const others = view.lines.filter(row => row !== view.worst && paths.rows[row]);
  const framed = [paths.waypoints.map(p => [p.x, p.y]), ...references.map(r => points(r.d)), ...(band ? [band] : []), ...(worst ? [points(worst.d)] : [])];
  if (framed.length === 1) framed.push(...others.map(row => points(paths.rows[row].d)));
  pathPlace.replaceChildren();
  if (framed.length === 1) {
    pathPlace.textContent = 'No path is kept of these trials.';
    return;
  }
  const wide = pathPlace.clientWidth, { scale, high, to } = frame(framed, wide, 236);
  const line = (list, name) => element('polyline', { class: name, points: list.map(p => to(p).map(v => v.toFixed(1)).join(',')).join(' ') });
  const svg = element('svg', { width: wide, height: high, viewBox: `0 0 ${wide} ${high}`, role: 'img', 'aria-labelledby': 'paths-legend' });
  if (band) svg.append(element('polygon', { class: 'band', points: band.map(p => to(p).map(v => v.toFixed(1)).join(',')).join(' ') }));
  for (const row of others) {
    const drawn = line(points(paths.rows[row].d), 'other ' + (paths.rows[row].fails ? 'fail' : 'pass'));
    drawn.dataset.row = row;
    svg.append(drawn);
  }
  for (const reference of references) svg.append(line(points(reference.d), 'reference'));
  for (const point of paths.waypoints) {
    const [x, y] = to([point.x, point.y]);
    svg.append(element('circle', { class: 'waypoint', cx: x, cy: y, r: 4 }, element('title', {}, point.name)));
  }
  const gapLine = row => {
    const path = paths.rows[row], reference = paths.references[path.reference];
    if (path.u === null || !reference) return [];
    return [line([at(points(path.d), path.u), at(points(reference.d), path.u)], 'gap')];
  };
  if (worst) svg.append(line(points(worst.d), 'worst ' + (worst.fails ? 'fail' : 'pass')), ...gapLine(view.worst));
  const length = roundLength(wide / 3 / scale);
  svg.append(element('path', { class: 'scale', d: `M10,${high - 8}h${(length * scale).toFixed(1)}` }),
    element('text', { class: 'scale', x: 10, y: high - 13 }, `${+length.toPrecision(1)} m`));
  const lit = element('g', { class: 'lit' });
  svg.append(lit);
  pathPlace.append(svg);
  legend(view, references, worst, others.length);
  const say = document.getElementById('paths-lit');
  const worstText = worst ? `Worst: row ${view.worst}, ${worst.text}.` : '';
  let shown = worst ? [view.worst] : [];
  say.textContent = worstText;
  const cursor = element('g', { class: 'cursor' });
  svg.append(cursor);
  // Where the shown rows and their references are at u.
  const place = u => {
    const rows = u === null ? [] : shown.filter(pairOf), pairs = rows.map(row => placesOf(pairOf(row), u));
    cursor.replaceChildren(...pairs.flatMap(pair => [line(pair, 'gap'), ...pair.map(p => {
      const [cx, cy] = to(p);
      return element('circle', { cx, cy, r: 3.5 });
    })]));
    return rows.length === 1 ? rows[0] : null;
  };
  const strips = stripsBelow(view, wide, place);
  pathPlace.append(...strips.drawings);
  lightRows = rows => {
    const known = rows.filter(row => paths.rows[row]);
    svg.classList.toggle('dimmed', known.length > 0);
    lit.replaceChildren(...known.map(row => line(points(paths.rows[row].d), paths.rows[row].fails ? 'fail' : 'pass')),
      ...(known.length === 1 ? gapLine(known[0]) : []));
    shown = known.length > 0 ? known : worst ? [view.worst] : [];
    say.textContent = rows.length === 0 ? worstText
      : known.length === 0 ? 'No path is kept of it.'
        : known.length === 1 ? `Row ${known[0]}: ${paths.rows[known[0]].text}.` : `${known.length} paths.`;
    strips.light(known);
    strips.cursor(null);
  };
  let pointed;
  for (const drawing of [svg, ...strips.drawings]) {
    drawing.addEventListener('mouseover', event => {
      const row = event.target.dataset?.row;
      if (row !== pointed) lightRows(row ? [Number(row)] : []);
      pointed = row;
    });
    drawing.addEventListener('mouseleave', () => lightRows([]));
    drawing.addEventListener('click', event => {
      const row = event.target.dataset?.row;
      if (row) location.hash = '#trials?.row=' + row;
    });
  }
  // On a path the cursor is at its nearest point.
  svg.addEventListener('pointermove', event => {
    const pair = shown.length === 1 ? pairOf(shown[0]) : null;
    if (!pair) return;
    const box = svg.getBoundingClientRect(), zoom = wide / box.width;
    const here = [(event.clientX - box.left) * zoom, (event.clientY - box.top) * zoom];
    const far = points(pair[0].d).map(p => Math.hypot(...to(p).map((v, i) => v - here[i])));
    const nearest = far.indexOf(Math.min(...far));
    strips.cursor(far[nearest] < 20 ? nearest / (far.length - 1) : null);
  });
  svg.addEventListener('pointerleave', () => strips.cursor(null));
}

function legend(view, references, worst, others) {
  const entry = (name, text) => {
    const item = document.createElement('span'), mark = document.createElement('i');
    mark.className = name;
    item.append(mark, text);
    return item;
  };
  const robots = references.filter(r => r.name.startsWith('robot')).length;
  const names = references.length < 3 ? references.map(r => r.name).join(', ')
    : robots === references.length ? `${robots} runs of the robot` : `${references.length} references`;
  document.getElementById('paths-legend').replaceChildren(
    'Seen from above. ',
    ...(view.band ? [entry('band', `middle 90 % of ${view.band_of} simulated runs`)] : []),
    ...(others > 0 ? [entry('other', `${others === view.drawn_of ? 'each' : others + ' of ' + view.drawn_of} of them`)] : []),
    ...(names ? [entry('reference', names)] : []),
    ...(worst ? [entry('worst' + (worst.fails ? ' fail' : ''), 'the worst'), entry('gap', 'its gap')] : []));
}

// ---- start ----

const choice = document.getElementById('view');
const remembered = 'rift view ' + location.pathname;
choice?.addEventListener('change', () => {
  try { sessionStorage.setItem(remembered, choice.value); } catch { /* not kept: it is all trials again */ }
  showView(Number(choice.value));
});
if (pathPlace) {
  let width = 0;
  new ResizeObserver(() => {
    if (pathPlace.clientWidth === width) return;
    width = pathPlace.clientWidth;
    drawPaths(Number(document.body.dataset.view ?? 0));
  }).observe(pathPlace);
}
drawPaths(0);
followHash();
Promise.all(page.charts.map(drawChart)).then(() => {
  let before = null;
  try { before = page.running ? sessionStorage.getItem(remembered) : null; } catch { /* likewise */ }
  if (choice && before && before < page.views.length) {
    choice.value = before;
    showView(Number(before));
  }
  document.body.dataset.drawn = page.charts.length;
  followRun();
});
