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

// The entries of a chart's first data set in a view; `fields` differ from view to view.
function entriesIn(chart, view) {
  if (chart.views.length === 0) return chart.base;
  return chart.base.map((entry, i) => {
    const own = { ...entry };
    chart.fields.forEach((field, k) => { own[field] = chart.views[view][i][k]; });
    if (own.tip && own.trials !== undefined) {
      own.tip = { ...own.tip, failing: own.value === null ? 'not tried' : `${own.value} % of ${own.trials} runs` };
    }
    if (own.tip && own.count !== undefined) own.tip = { ...own.tip, trials: String(own.count) };
    return own;
  });
}

function drawChart(chart, index) {
  const place = document.getElementById('chart-' + index);
  const table = chart.spec.data[0].name;
  chart.base = chart.spec.data[0].values;
  chart.spec.data[0].values = entriesIn(chart, 0);
  const dots = chart.spec.data.find(set => set.name === 'trials')?.values;
  const view = new vega.View(vega.parse(chart.spec, chartConfig), {
    renderer: 'svg', container: place, hover: true, tooltip: showTip,
  });
  view.description(place.closest('figure').querySelector('h2, h3').textContent);
  view.addEventListener('click', (event, item) => {
    if (item?.datum?.query) location.hash = '#trials?' + item.datum.query;
  });
  let width = place.clientWidth;
  new ResizeObserver(() => {
    if (place.clientWidth === width || place.clientWidth === 0) return;
    width = place.clientWidth;
    view.width(width).runAsync();
  }).observe(place);
  chart.show = (k) => {
    if (chart.views.length === 0) return;
    view.data(table, entriesIn(chart, k));
    if (dots) view.data('trials', dots.filter(dot => !page.rowsShown || page.rowsShown.has(dot.row)));
    view.runAsync();
  };
  return view.width(width).runAsync();
}

// ---- tables ----

// Parameters stand in cells as text, in the experiment's own spelling.
function asNumber(cell) {
  return String(cell).trim() === '' ? NaN : Number(cell);
}

// What a search drew has sixteen digits, of which four are read; table.csv has all.
function shortText(text) {
  const isLong = text.replace(/e.*$/, '').replace(/\D/g, '').replace(/^0+/, '').length > 5;
  return isLong && Number.isFinite(asNumber(text)) ? String(Number(Number(text).toPrecision(4))) : text;
}

function cellText(value, column) {
  if (value === null) return '–';
  if (column.digits !== undefined) return value.toFixed(column.digits);
  return column.name === undefined ? String(value) : shortText(String(value));
}

// Values that are missing come last, whichever way is up; numbers come before words.
function compare(a, b) {
  if (a === null || b === null) return a === b ? 0 : a === null ? Infinity : -Infinity;
  const x = asNumber(a), y = asNumber(b);
  if (Number.isFinite(x) && Number.isFinite(y)) return x - y;
  if (Number.isFinite(x) !== Number.isFinite(y)) return Number.isFinite(x) ? -1 : 1;
  return String(a).localeCompare(String(b), undefined, { numeric: true });
}

// A page opened from a disk knows its folder, which is that of the sweep, unless its name is no UTF-8.
function ownFolder() {
  if (location.protocol !== 'file:') return 'DIR';
  try {
    return decodeURIComponent(location.pathname.replace(/\/[^/]*$/, ''));
  } catch {
    return 'DIR';
  }
}
const folder = ownFolder();
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
    row.dataset.index = index;
    if (data === page.trials) row.dataset.row = data.rows[index][0];
    data.columns.forEach((column, i) => {
      const cell = row.insertCell();
      if (column.again && data.rows[index][i] !== null) {
        cell.append(againButton(column.again, data.rows[index][i]));
        return;
      }
      cell.textContent = cellText(data.rows[index][i], column);
      if (column.name && cell.textContent !== String(data.rows[index][i])) cell.title = data.rows[index][i];
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

// ---- from a number to its rows: #trials?surface=ground&.row=3,5 ----

const everything = () => true;
const shown = { linked: everything, trials: everything, settings: everything };

function matcher(data, query) {
  const wanted = [];
  for (const [name, text] of query) {
    // A parameter's name holds no dot: what begins with one is a column of the page's own.
    const i = data.columns.findIndex(column => (column.name ?? '.' + column.title) === name);
    if (i < 0) return null;
    const values = new Set(name === '.row' ? text.split(',') : [text]);
    const isFailed = name === '.result' && text === 'failed';  // whatever it failed by
    wanted.push(index => isFailed ? data.marks[index] === 'fail' : values.has(String(data.rows[index][i])));
  }
  return index => wanted.every(holds => holds(index));
}

function followHash() {
  const [id, text] = location.hash.slice(1).split('?');
  if (id !== 'trials') return;
  const data = page.trials, query = [...new URLSearchParams(text ?? '')];
  const holds = matcher(data, query);
  if (!holds) return;
  shown.linked = holds;
  const count = data.rows.filter((_, i) => holds(i) && shown.trials(i)).length;
  const bar = document.getElementById('filter');
  bar.hidden = query.length === 0;
  const words = query.map(([name, value]) =>
    name === '.row' ? `row ${value.replaceAll(',', ', ')}` : `${name.replace(/^\./, '')} ${value}`).join(' and ');
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
  const isShown = id === 'trials' ? i => shown.trials(i) && shown.linked(i) : i => shown.settings(i);
  refill[id] = () => fillBody(table, data, order.filter(isShown));
  data.columns.forEach((column, i) => {
    const th = document.createElement('th');
    th.scope = 'col';
    th.className = column.digits === undefined ? '' : 'number';
    th.setAttribute('aria-sort', 'none');
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = column.title;
    button.title = page.words[column.title] ?? '';
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
  const light = event => {
    const row = event.target.closest?.('tbody tr');
    if (row) lightRows(rowsOf(id, Number(row.dataset.index)));
  };
  for (const kind of ['mouseover', 'focusin']) table.addEventListener(kind, light);
  for (const kind of ['mouseleave', 'focusout']) table.addEventListener(kind, () => lightRows([]));
}

// Numbers of the trials that a row of a table stands for.
function rowsOf(id, index) {
  const data = page[id];
  if (id === 'trials') return [data.rows[index][0]];
  const names = data.columns.flatMap((column, i) => column.name === undefined ? [] : [[column.name, String(data.rows[index][i])]]);
  const holds = matcher(page.trials, names);
  return page.trials.rows.flatMap((row, i) => holds?.(i) ? [row[0]] : []);
}

// ---- the filter ----

function sentence(pieces) {
  return pieces.map(([text, query]) => {
    if (query === '') return document.createTextNode(text);
    const link = document.createElement('a');
    link.href = '#trials?' + query;
    link.textContent = text;
    return link;
  });
}

function showView(k) {
  const view = page.views[k], query = [...new URLSearchParams(view.query)];
  shown.trials = matcher(page.trials, query) ?? everything;
  const names = new Set(page.settings.columns.map(column => column.name));
  shown.settings = matcher(page.settings, query.filter(([name]) => names.has(name))) ?? everything;
  const whole = k === 0;
  page.rowsShown = whole ? null : new Set(page.trials.rows.flatMap((row, i) => shown.trials(i) ? [row[0]] : []));
  const headline = document.getElementById('headline');
  headline.className = 'headline ' + view.outcome;
  headline.replaceChildren(...(whole ? [] : [view.name + ': ']), ...sentence(view.headline));
  document.body.dataset.view = k;
  refill.trials();
  refill.settings();
  for (const chart of page.charts) chart.show?.(k);
  drawPaths(k);
}

// ---- words explained ----

function explainWords() {
  const words = Object.entries(page.words).sort(([a], [b]) => b.length - a.length);
  const list = document.getElementById('glossary');
  for (const [word, meaning] of Object.entries(page.words)) {
    const term = document.createElement('dt'), text = document.createElement('dd');
    term.textContent = word;
    text.textContent = meaning;
    list.append(term, text);
  }
  const escaped = words.map(([word]) => word.replace(/[.*+?^${}()|[\]\\]/g, '\\$&'));
  const any = new RegExp(`(?<![\\w-])(?:${escaped.join('|')})(?![\\w-])`);
  for (const block of document.querySelectorAll('.explained')) {
    const seen = new Set();
    const walker = document.createTreeWalker(block, NodeFilter.SHOW_TEXT, {
      acceptNode: node => node.parentElement.closest('a, button, table, abbr, svg, h2, h3, summary, select')
        ? NodeFilter.FILTER_REJECT : NodeFilter.FILTER_ACCEPT,
    });
    const texts = [];
    while (walker.nextNode()) texts.push(walker.currentNode);
    for (let node of texts) {
      for (let found = any.exec(node.data); found; found = any.exec(node.data)) {
        const word = node.splitText(found.index);
        node = word.splitText(found[0].length);
        if (seen.has(found[0])) continue;
        seen.add(found[0]);
        const abbr = document.createElement('abbr');
        abbr.title = page.words[found[0]];
        word.replaceWith(abbr);
        abbr.append(word);
      }
    }
  }
}

// ---- a sweep that still runs: the page asks for itself again ----

function followRun() {
  const follow = document.getElementById('follow');
  if (!follow || !page.running) return;
  setInterval(() => { if (follow.checked && !document.hidden) location.reload(); }, 3000);
}

makeTable('settings');
makeTable('trials');
document.querySelector('#filter button').addEventListener('click', () => { location.hash = '#trials?'; });
addEventListener('hashchange', followHash);
explainWords();
// What follows is in paths.js.
