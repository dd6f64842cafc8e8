// A `require` for Vega's modules, which follow in this script (cmake/Vega.cmake).
const riftModules = {};

function riftModule(name, body) {
  const exports = {};
  riftModules[name] = exports;
  body(exports, { exports }, (wanted) => riftModules[wanted === 'vega-selections' ? 'vega-selection' : wanted]);
}
