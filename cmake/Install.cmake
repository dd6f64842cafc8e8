# What `cmake --install` puts where: the two programs, their manual and completions (made by rift
# itself, so that they tell what it takes), the experiments and recordings that it finds from any
# folder (FindInput()), and the library of the rooms that need no camera, for other CMake projects.
install(TARGETS rift COMPONENT rift)
install(TARGETS rift-camera DESTINATION lib/rift COMPONENT rift)

set(manual "${PROJECT_BINARY_DIR}/manual")
file(MAKE_DIRECTORY "${manual}")
set(pages "${manual}/rift.1")
add_custom_command(OUTPUT "${manual}/rift.1" COMMAND rift help --man > "${manual}/rift.1"
                   DEPENDS rift VERBATIM)
foreach(command simulate track drive gap sweep)
  set(page "${manual}/rift-${command}.1")
  add_custom_command(OUTPUT "${page}" COMMAND rift help --man ${command} > "${page}"
                     DEPENDS rift VERBATIM)
  list(APPEND pages "${page}")
endforeach()
foreach(shell bash zsh)
  add_custom_command(OUTPUT "${manual}/${shell}" COMMAND rift help --${shell} > "${manual}/${shell}"
                     DEPENDS rift VERBATIM)
endforeach()
add_custom_target(rift_manual ALL DEPENDS ${pages} "${manual}/bash" "${manual}/zsh")
install(FILES ${pages} DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT rift)
install(FILES "${manual}/bash" DESTINATION share/bash-completion/completions RENAME rift
        COMPONENT rift)
install(FILES "${manual}/zsh" DESTINATION share/zsh/vendor-completions RENAME _rift COMPONENT rift)

install(DIRECTORY configs DESTINATION share/rift COMPONENT rift)
install(DIRECTORY data/example data/camera DESTINATION share/rift/data COMPONENT rift)
install(DIRECTORY src/firmware/ DESTINATION share/rift/firmware COMPONENT rift)
install(DIRECTORY docs/ DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT rift)
install(FILES README.md CHANGELOG.md DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT rift)
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}" RENAME copyright COMPONENT rift)

set(exported limits statistics files geometry yaml trajectory control trial gap odometry search simulation)
foreach(room ${exported})
  install(TARGETS rift_${room} EXPORT riftTargets COMPONENT dev)
  set_target_properties(rift_${room} PROPERTIES EXPORT_NAME ${room})
  install(DIRECTORY "include/rift/${room}" DESTINATION include/rift COMPONENT dev)
endforeach()
set(config "${CMAKE_INSTALL_LIBDIR}/cmake/rift")
install(EXPORT riftTargets NAMESPACE rift:: DESTINATION "${config}" COMPONENT dev)
include(CMakePackageConfigHelpers)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/generated/riftConfigVersion.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(FILES cmake/riftConfig.cmake "${PROJECT_BINARY_DIR}/generated/riftConfigVersion.cmake"
        DESTINATION "${config}" COMPONENT dev)
