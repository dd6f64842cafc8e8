
// ---- the error along the paths, with one cursor through it and the paths ----

// The path of a row and that of its reference; null where holding them together says nothing: no
// reference, or a robot that did not arrive.
function pairOf(row) {
  const path = page.paths.rows[row], reference = page.paths.references[path?.reference];
  return reference && path.u !== null ? [points(path.d), points(reference.d)] : null;
}

const distance = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]);

// [u, metres] of a row against its reference at equal shares u of their lengths.
function errorsOf(row) {
  const pair = pairOf(row);
  if (!pair) return null;
  const last = Math.max(...pair.map(path => path.length)) - 1;
  return Array.from({ length: last + 1 }, (_, i) => [i / last, distance(pair.map(path => at(path, i / last)))]);
}

// A strip below the paths. Its `cursor` moves over u, by pointer or arrow keys, and shows what
// `placed(u)` says of that place; null takes the cursor away.
function errorStrip(view, wide, placed) {
  const rows = view.lines.filter(row => row !== view.worst);
  const worst = view.worst ? errorsOf(view.worst) : null;
  const lines = rows.map(row => [row, errorsOf(row)]).filter(([, errors]) => errors);
  const first = worst ?? lines[0]?.[1];
  if (!first) return null;
  const high = 84, left = 46, right = wide - 26, top = 6, foot = high - 20;
  const threshold = page.paths.threshold_m;
  const most = 1.05 * Math.max(threshold, 1e-3, ...first.map(([, m]) => m));
  const x = u => left + u * (right - left), y = m => foot - Math.min(m / most, 1.2) * (foot - top);
  const line = (errors, name) => element('polyline', { class: name, points: errors.map(([u, m]) => `${x(u).toFixed(1)},${y(m).toFixed(1)}`).join(' ') });
  const label = (text, place) => element('text', { class: 'label', ...place }, text);
  const svg = element('svg', {
    class: 'errors', width: wide, height: high, viewBox: `0 0 ${wide} ${high}`, tabindex: 0, role: 'slider',
    'aria-label': 'Place along the path, for the error there', 'aria-valuemin': 0, 'aria-valuemax': 1, 'aria-valuenow': 0,
  });
  const style = row => page.paths.rows[row].fails ? 'fail' : 'pass';
  for (const [row, errors] of lines) {
    const drawn = line(errors, 'other ' + style(row));
    drawn.dataset.row = row;
    svg.append(drawn);
  }
  if (worst) svg.append(line(worst, 'worst ' + style(view.worst)));
  const meaning = 'error (m) along the path; dashed: threshold';
  const caption = label(meaning, { x: (left + right) / 2, y: high - 5, 'text-anchor': 'middle' });
  const mark = element('path', { class: 'cursor', d: `M0,${top}V${foot}`, visibility: 'hidden' });
  const lit = element('g', { class: 'lit' });
  svg.append(lit, mark,
    element('path', { class: 'axis', d: `M${left},${top}V${foot}H${right}` }),
    element('path', { class: 'gap', d: `M${left},${y(threshold).toFixed(1)}H${right}` }),
    label('0', { x: left - 5, y: foot + 3, 'text-anchor': 'end' }),
    label(most.toPrecision(2), { x: left - 5, y: top + 9, 'text-anchor': 'end' }),
    label('start', { x: left, y: high - 5 }),
    caption,
    label('end', { x: right, y: high - 5, 'text-anchor': 'end' }));
  let now = 0;
  const cursor = u => {
    mark.setAttribute('visibility', u === null ? 'hidden' : 'visible');
    if (u !== null) {
      now = Math.min(1, Math.max(0, u));
      mark.setAttribute('transform', `translate(${x(now).toFixed(1)})`);
      svg.setAttribute('aria-valuenow', now.toFixed(2));
    }
    const here = placed(u === null ? null : now);
    caption.textContent = here || meaning;
    svg.setAttribute('aria-valuetext', here || 'no place');
  };
  svg.addEventListener('pointermove', event => {
    const box = svg.getBoundingClientRect();
    cursor((event.clientX - box.left - left * box.width / wide) / ((right - left) * box.width / wide));
  });
  for (const kind of ['pointerleave', 'blur']) svg.addEventListener(kind, () => cursor(null));
  svg.addEventListener('keydown', event => {
    const step = { ArrowRight: 0.01, ArrowLeft: -0.01, PageUp: 0.1, PageDown: -0.1, Home: -1, End: 1 }[event.key];
    if (step === undefined) return;
    event.preventDefault();
    cursor(now + step);
  });
  const light = rows => {
    svg.classList.toggle('dimmed', rows.length > 0);
    lit.replaceChildren(...rows.map(row => [row, errorsOf(row)]).filter(([, errors]) => errors)
      .map(([row, errors]) => line(errors, style(row))));
  };
  return { svg, cursor, light };
}
