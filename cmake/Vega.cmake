# Debian's libjs-vega holds Vega as separate modules, each of which, loaded by a plain <script>,
# overwrites the global the one before has made. vega_modules.js gives them the `require` they ask
# for, and this joins what our charts need, in the order of their dependencies.
set(RIFT_VEGA_DIR "/usr/share/javascript/vega" CACHE PATH "Where libjs-vega keeps its modules")

# The last is not named as it is required: vega-functions asks for "vega-selections".
set(RIFT_VEGA_MODULES
  vega-util vega-time vega-format vega-loader vega-dataflow vega-statistics vega-transforms
  vega-scale vega-canvas vega-scenegraph vega-view-transforms vega-expression vega-selection
  vega-functions vega-encode vega-runtime vega-event-selector vega-parser vega-view)

# rift_join_vega(OUTPUT): one script that defines `vega.parse` and `vega.View`.
function(rift_join_vega output)
  set(script "")
  foreach(module IN LISTS RIFT_VEGA_MODULES)
    set(path "${RIFT_VEGA_DIR}/${module}.min.js")
    if(NOT EXISTS "${path}")
      message(FATAL_ERROR "The charts of the report need Vega, and ${path} is not there: "
                          "apt-get install libjs-vega, or say where it is with -DRIFT_VEGA_DIR=...")
    endif()
    file(READ "${path}" text)
    # A map of its source is one more file that a browser would ask for.
    string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" text "${text}")
    string(APPEND script
           "riftModule('${module}', function (exports, module, require) {\n${text}\n});\n")
  endforeach()
  file(WRITE "${output}" "${script}")
endfunction()
