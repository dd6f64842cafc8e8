# Writes OUTPUT when the text has changed; SOURCE may be no clone.
execute_process(COMMAND git -C "${SOURCE}" describe --always --dirty=-changed --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE
                RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
endif()
file(WRITE "${OUTPUT}.new" "#include \"version.hpp\"

namespace rift::commands {

std::string VersionText() {
  return \"rift ${VERSION}\\n\"
         \"commit:    ${commit}\\n\"
         \"compiler:  ${COMPILER}\\n\"
         \"libraries: ${LIBRARIES}\\n\";
}

}  // namespace rift::commands
")
file(COPY_FILE "${OUTPUT}.new" "${OUTPUT}" ONLY_IF_DIFFERENT)
