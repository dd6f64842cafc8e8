# Files that the program carries inside, so that a report needs nothing beside the binary.

# What report.html is made of: the files of src/report/page/assets and Vega.
function(rift_embed_report_page)
  rift_join_vega("${PROJECT_BINARY_DIR}/generated/vega.js")
  file(GLOB files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/report/page/assets/*.*"
       "${PROJECT_SOURCE_DIR}/src/report/page/assets/charts/*.json")
  rift_embed(rift_report_page ${files} "${PROJECT_BINARY_DIR}/generated/vega.js")
  target_include_directories(rift_report_page PRIVATE "${PROJECT_SOURCE_DIR}/src/report/page")
endfunction()

# rift_embed(TARGET FILE...): each file becomes an entry of Embedded(), named by its file name.
function(rift_embed target)
  set(code "// Made by cmake/Embed.cmake.\n#include \"embedded.hpp\"\n\nnamespace rift::report {\n\n")
  string(APPEND code "const std::vector<EmbeddedFile>& EmbeddedFiles() {\n")
  string(APPEND code "  static const std::vector<EmbeddedFile> files = {\n")
  foreach(path IN LISTS ARGN)
    get_filename_component(name "${path}" NAME)
    file(READ "${path}" text)
    string(APPEND code "{\"${name}\", R\"~rift~(${text})~rift~\"},\n")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${path}")
  endforeach()
  string(APPEND code "  };\n  return files;\n}\n\n}  // namespace rift::report\n")
  set(generated "${PROJECT_BINARY_DIR}/generated/${target}_embedded.cpp")
  file(WRITE "${generated}.new" "${code}")
  file(COPY_FILE "${generated}.new" "${generated}" ONLY_IF_DIFFERENT)
  target_sources(${target} PRIVATE "${generated}")
endfunction()
