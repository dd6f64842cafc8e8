
// ---- strips below the paths: error and speed along them, with one cursor through all ----

// The path of a row and that of its reference; null where holding them together says nothing: no
// reference, or a robot that did not arrive.
function pairOf(row) {
  const path = page.paths.rows[row], reference = page.paths.references[path?.reference];
  return reference && path.u !== null ? [path, reference] : null;
}

const distance = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]);

// Where both are after equal shares u of their lengths.
const placesOf = (pair, u) => pair.map(path => at(points(path.d), u));

// [u, metres] of a row against its reference.
function errorsOf(row) {
  const pair = pairOf(row);
  if (!pair) return null;
  const last = Math.max(...pair.map(path => points(path.d).length)) - 1;
  return Array.from({ length: last + 1 }, (_, i) => [i / last, distance(placesOf(pair, i / last))]);
}

// [u, metres a second] at the points of a path, each from the way of some points around it, since a
// camera's stamps are no finer; null where the times are not known.
function speedsOf(path) {
  const place = points(path.d), last = place.length - 1, around = 2;
  if (path.t.length !== last) return null;
  const sum = values => values.reduce((all, value) => all + value, 0);
  const steps_m = path.t.map((_, i) => distance([place[i], place[i + 1]]));
  return place.map((_, i) => {
    const some = [Math.max(0, i - around), i + around];
    return [i / last, sum(steps_m.slice(...some)) / (Math.max(sum(path.t.slice(...some)), 1) * page.paths.unit_s)];
  });
}

// The value of a list of [u, value] at u.
function valueAt(list, u) {
  const i = Math.min(list.length - 2, Math.max(0, list.findIndex(([next]) => next > u) - 1));
  const [[u0, v0], [u1, v1]] = [list[i], list[i + 1]], f = Math.min(1, Math.max(0, (u - u0) / (u1 - u0)));
  return v0 + f * (v1 - v0);
}

// What the strips show: [u, value] of a row, of its reference where it has a line of its own, a
// constant that is drawn dashed, and what the caption says at the cursor of a row that has a pair.
const measures = [
  {
    meaning: 'error (m) from start to end; dashed: threshold', threshold: () => page.paths.threshold_m,
    of: errorsOf, ofReference: () => null,
    says: (u, row) => `At ${Math.round(100 * u)} % of the way: ${distance(placesOf(pairOf(row), u)).toFixed(3)} m.`,
  },
  {
    meaning: 'speed (m/s) from start to end', threshold: () => null,
    of: row => pairOf(row) && speedsOf(pairOf(row)[0]),
    ofReference: row => pairOf(row) && speedsOf(pairOf(row)[1]),
    says: (u, row) => {
      const [own, other] = pairOf(row).map(speedsOf);
      if (!own) return '';
      return `There at ${valueAt(own, u).toFixed(2)} m/s${other ? `, the reference at ${valueAt(other, u).toFixed(2)} m/s` : ''}.`;
    },
  },
];

function strip(measure, view, wide) {
  const rows = view.lines.filter(row => row !== view.worst);
  const lines = rows.map(row => [row, measure.of(row)]).filter(([, values]) => values);
  const worst = view.worst ? measure.of(view.worst) : null, first = worst ? view.worst : lines[0]?.[0];
  if (first === undefined) return null;
  const left = 46, right = wide - 26, top = 6, foot = 58, high = 74;
  const threshold = measure.threshold(), reference = measure.ofReference(first);
  const drawn = [...lines.map(([, values]) => values), worst ?? [], reference ?? []].flat();
  const most = 1.05 * drawn.reduce((high, [, value]) => Math.max(high, value), Math.max(threshold ?? 0, 1e-3));
  const x = u => left + u * (right - left), y = value => foot - Math.min(value / most, 1.2) * (foot - top);
  const line = (values, name) => element('polyline', { class: name, points: values.map(([u, value]) => `${x(u).toFixed(1)},${y(value).toFixed(1)}`).join(' ') });
  const label = (text, place) => element('text', { class: 'label', ...place }, text);
  const svg = element('svg', {
    class: 'strip', width: wide, height: high, viewBox: `0 0 ${wide} ${high}`, tabindex: 0, role: 'slider',
    'aria-label': `Place along the path, for the ${measure.meaning.split(' ')[0]} there`,
    'aria-valuemin': 0, 'aria-valuemax': 1, 'aria-valuenow': 0,
  });
  const style = row => page.paths.rows[row].fails ? 'fail' : 'pass';
  for (const [row, values] of lines) {
    const other = line(values, 'other ' + style(row));
    other.dataset.row = row;
    svg.append(other);
  }
  const own = element('g', { class: 'own' });
  if (reference && worst) own.append(line(reference, 'reference'));
  if (worst) own.append(line(worst, 'worst ' + style(view.worst)));
  const meaning = measure.meaning + (reference ? '; thin: reference' : '');
  const caption = label(meaning, { x: (left + right) / 2, y: high - 4, 'text-anchor': 'middle' });
  const mark = element('path', { class: 'cursor', d: `M0,${top}V${foot}`, visibility: 'hidden' });
  const lit = element('g', { class: 'lit' });
  svg.append(own, lit, mark, element('path', { class: 'axis', d: `M${left},${top}V${foot}H${right}` }),
    label('0', { x: left - 5, y: foot + 3, 'text-anchor': 'end' }),
    label(most.toPrecision(2), { x: left - 5, y: top + 9, 'text-anchor': 'end' }), caption);
  if (threshold) svg.append(element('path', { class: 'gap', d: `M${left},${y(threshold).toFixed(1)}H${right}` }));
  const uOf = event => {
    const box = svg.getBoundingClientRect(), zoom = box.width / wide;
    return (event.clientX - box.left - left * zoom) / ((right - left) * zoom);
  };
  // u of null takes the cursor away; the words are of that one row, if it is one.
  const show = (u, row) => {
    mark.setAttribute('visibility', u === null ? 'hidden' : 'visible');
    if (u !== null) {
      mark.setAttribute('transform', `translate(${x(u).toFixed(1)})`);
      svg.setAttribute('aria-valuenow', u.toFixed(2));
    }
    const here = u !== null && row ? measure.says(u, row) : '';
    caption.textContent = here || meaning;
    svg.setAttribute('aria-valuetext', here || 'no place');
  };
  const light = rows => {
    svg.classList.toggle('dimmed', rows.length > 0);
    const other = rows.length === 1 && measure.of(rows[0]) ? measure.ofReference(rows[0]) : null;
    lit.replaceChildren(...(other ? [line(other, 'reference')] : []),
      ...rows.map(row => [row, measure.of(row)]).filter(([, values]) => values)
        .map(([row, values]) => line(values, style(row))));
  };
  return { svg, uOf, show, light };
}

// The strips of a view. Their cursor moves over u, by pointer or arrow keys; `placed(u)` is told, and
// gives back the one row that the words are of, or null.
function stripsBelow(view, wide, placed) {
  const strips = measures.map(measure => strip(measure, view, wide)).filter(made => made);
  let now = 0;
  const cursor = u => {
    if (u !== null) now = Math.min(1, Math.max(0, u));
    const at = u === null ? null : now, row = placed(at);
    for (const one of strips) one.show(at, row);
  };
  for (const { svg, uOf } of strips) {
    svg.addEventListener('pointermove', event => cursor(uOf(event)));
    for (const kind of ['pointerleave', 'blur']) svg.addEventListener(kind, () => cursor(null));
    svg.addEventListener('keydown', event => {
      const step = { ArrowRight: 0.01, ArrowLeft: -0.01, PageUp: 0.1, PageDown: -0.1, Home: -1, End: 1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      cursor(now + step);
    });
  }
  return { drawings: strips.map(one => one.svg), cursor, light: rows => strips.forEach(one => one.light(rows)) };
}
