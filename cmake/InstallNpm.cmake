# cmake -DSOURCE=... -DFOLDER=... -P: npm ci of SOURCE/package-lock.json in FOLDER. The file
# FOLDER/installed says that it worked; without it the next build tries again.
file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" DESTINATION "${FOLDER}")
file(REMOVE "${FOLDER}/installed")
find_program(NPM npm)
if(NOT NPM)
  message(NOTICE "npm is not installed: the tests that need its packages will be skipped")
  return()
endif()
execute_process(COMMAND "${NPM}" ci --no-audit --no-fund --ignore-scripts
                WORKING_DIRECTORY "${FOLDER}" RESULT_VARIABLE failed
                OUTPUT_VARIABLE said ERROR_VARIABLE said TIMEOUT 120)
if(failed)
  message(NOTICE "npm ci did not work, so the tests that need its packages will be skipped:\n${said}")
  return()
endif()
file(TOUCH "${FOLDER}/installed")
