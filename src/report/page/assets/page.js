'use strict';
const page = JSON.parse(document.getElementById('page-data').textContent);

// ---- charts ----

Object.assign(riftModules['vega-dataflow'].transforms, riftModules['vega-transforms'],
  riftModules['vega-view-transforms'], riftModules['vega-encode']);
const vega = { parse: riftModules['vega-parser'].parse, View: riftModules['vega-view'].View };

// currentColor follows the theme of the page, on screen and on paper, without drawing again.
const font = 'system-ui, "DejaVu Sans", Arial, sans-serif';
const chartConfig = {
  background: null,
  axis: {
    labelColor: 'currentColor', titleColor: 'currentColor', domainColor: '#888', tickColor: '#888',
    gridColor: '#888', gridOpacity: 0.25, labelFont: font, titleFont: font,
    labelFontSize: 12, titleFontSize: 12, titleFontWeight: 'normal', labelLimit: 170,
  },
  legend: {
    labelColor: 'currentColor', titleColor: 'currentColor', labelFont: font, titleFont: font,
    labelFontSize: 12, titleFontSize: 12, titleFontWeight: 'normal',
  },
  text: { font, fontSize: 12 },
};

const tip = document.getElementById('tip');

function showTip(handler, event, item, value) {
  tip.hidden = value == null || value === '';
  if (tip.hidden) return;
  tip.replaceChildren(...Object.entries(value).map(([key, text]) => {
    const line = document.createElement('div');
    const name = document.createElement('b');
    name.textContent = key + ': ';
    line.append(name, text);
    return line;
  }));
  const box = tip.getBoundingClientRect();
  const x = Math.min(event.clientX + 12, innerWidth - box.width - 6);
  const y = event.clientY + 14 + box.height > innerHeight ? event.clientY - box.height - 10 : event.clientY + 14;
  tip.style.left = Math.max(4, x) + 'px';
  tip.style.top = Math.max(4, y) + 'px';
}

function drawChart(chart, index) {
  const place = document.getElementById('chart-' + index);
  const view = new vega.View(vega.parse(chart, chartConfig), {
    renderer: 'svg', container: place, hover: true, tooltip: showTip,
  });
  const fit = () => view.width(place.clientWidth).runAsync();
  let width = place.clientWidth;
  new ResizeObserver(() => {
    if (place.clientWidth === width || place.clientWidth === 0) return;
    width = place.clientWidth;
    fit();
  }).observe(place);
  return fit();
}

// ---- tables ----

function cellText(value, column) {
  if (value === null) return '–';
  return column.digits === undefined ? String(value) : value.toFixed(column.digits);
}

// Parameters stand in cells as text, in the experiment's own spelling.
function asNumber(cell) {
  return String(cell).trim() === '' ? NaN : Number(cell);
}

// Values that are missing come last, whichever way is up; numbers come before words.
function compare(a, b) {
  if (a === null || b === null) return a === b ? 0 : a === null ? Infinity : -Infinity;
  const x = asNumber(a), y = asNumber(b);
  if (Number.isFinite(x) && Number.isFinite(y)) return x - y;
  if (Number.isFinite(x) !== Number.isFinite(y)) return Number.isFinite(x) ? -1 : 1;
  return String(a).localeCompare(String(b), undefined, { numeric: true });
}

// A page opened from a disk knows its folder, which is that of the sweep.
const folder = location.protocol === 'file:' ? decodeURIComponent(location.pathname.replace(/\/[^/]*$/, '')) : 'DIR';
const quoted = /^[\w./-]+$/.test(folder) ? folder : "'" + folder.replaceAll("'", "'\\''") + "'";

// A row of the sweep is driven again by its number; recorded logs are named.
function againButton(kind, value) {
  const button = document.createElement('button');
  button.type = 'button';
  button.textContent = kind === 'gap' ? `rift gap ${value}` : `rift simulate --replay ${quoted} ${value}`;
  button.addEventListener('click', () => navigator.clipboard?.writeText(button.textContent));
  return button;
}

function fillBody(table, data, order) {
  const body = document.createElement('tbody');
  for (const index of order) {
    const row = body.insertRow();
    row.className = data.marks[index];
    data.columns.forEach((column, i) => {
      const cell = row.insertCell();
      if (column.again && data.rows[index][i] !== null) {
        cell.append(againButton(column.again, data.rows[index][i]));
        return;
      }
      cell.textContent = cellText(data.rows[index][i], column);
      cell.className = (column.digits === undefined ? '' : 'number') + (column.mark ? ' mark' : '');
    });
  }
  table.tBodies[0]?.remove();
  table.append(body);
}

function sortedOrder(data, column, descending) {
  const order = data.rows.map((_, i) => i);
  return order.sort((i, j) => {
    const way = compare(data.rows[i][column], data.rows[j][column]);
    return Math.abs(way) === Infinity || !descending ? way || i - j : -way || i - j;
  });
}

// ---- from a number to its rows: #trials?surface=ground&row=3,5 ----

const shown = { trials: () => true, settings: () => true };

function matcher(data, query) {
  const wanted = [];
  for (const [title, text] of query) {
    const i = data.columns.findIndex(column => column.title === title);
    if (i < 0) return null;
    const values = new Set(title === 'row' ? text.split(',') : [text]);
    wanted.push(row => values.has(String(row[i])));
  }
  return index => wanted.every(holds => holds(data.rows[index]));
}

function followHash() {
  const [id, text] = location.hash.slice(1).split('?');
  if (id !== 'trials') return;
  const data = page.trials, query = [...new URLSearchParams(text ?? '')];
  const holds = matcher(data, query);
  if (!holds) return;
  shown.trials = holds;
  const count = data.rows.filter((_, i) => holds(i)).length;
  const bar = document.getElementById('filter');
  bar.hidden = query.length === 0;
  const words = query.map(([title, value]) => `${title} ${value.replaceAll(',', ', ')}`).join(' and ');
  bar.querySelector('span').textContent = `${count} of the ${data.rows.length} trials on this page have ${words}.` +
    (data.complete ? '' : ' table.csv has all trials.');
  refill.trials();
  if (query.length > 0) document.getElementById('rows').scrollIntoView();
}

const refill = {};

function makeTable(id) {
  const table = document.getElementById(id);
  const data = page[id];
  const head = table.createTHead().insertRow();
  let order = data.rows.map((_, i) => i);
  refill[id] = () => fillBody(table, data, order.filter(index => shown[id](index)));
  data.columns.forEach((column, i) => {
    const th = document.createElement('th');
    th.scope = 'col';
    th.className = column.digits === undefined ? '' : 'number';
    th.setAttribute('aria-sort', 'none');
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = column.title;
    button.addEventListener('click', () => {
      const descending = th.getAttribute('aria-sort') === 'ascending';
      for (const other of head.cells) other.setAttribute('aria-sort', 'none');
      th.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
      order = sortedOrder(data, i, descending);
      refill[id]();
    });
    th.append(button);
    head.append(th);
  });
  refill[id]();
}

makeTable('settings');
makeTable('trials');
document.querySelector('#filter button').addEventListener('click', () => { location.hash = '#trials?'; });
addEventListener('hashchange', followHash);
followHash();
Promise.all(page.charts.map(drawChart)).then(() => { document.body.dataset.drawn = page.charts.length; });
