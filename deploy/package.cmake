# SPDX-License-Identifier: Apache-2.0
# The Debian packages: what each of them holds, and what CPack says of it. deploy/package makes them.
#
# One component is one package: gateway (axisgate), dds (axisgate-dds), web (axisgate-web), simulator (axisgate-sim). A program installs itself where it
# is declared; what goes with it is here. Another package is another component here and its description in deploy/debian/cpack.cmake.

find_program(GZIP gzip REQUIRED)

# A file of a component that deploy/debian/file.cmake makes when the package is made, at DESTINATION below the prefix: it runs CODE,
# which puts the file at ${FILE}. Compressed where the name says so. It goes where it belongs at once: nothing is kept in the build
# folder, so that two makings at a time do not take each other's files.
function(axisgate_package_file component destination code)
  install(CODE "
    set(GZIP \"${GZIP}\")
    set(DESTINATION \"${destination}\")
    set(FOLDER \"${CMAKE_SOURCE_DIR}/deploy/debian\")
    macro(make_file)
      ${code}
    endmacro()
    include(\"${CMAKE_SOURCE_DIR}/deploy/debian/file.cmake\")" COMPONENT ${component} EXCLUDE_FROM_ALL)
endfunction()

function(axisgate_package_copy component source destination)
  axisgate_package_file(${component} ${destination} "file(COPY_FILE \"${source}\" \"\${FILE}\")")
endfunction()

# The documents that every package has.
function(axisgate_package_documents component package)
  set(folder share/doc/${package})
  axisgate_package_copy(${component} ${CMAKE_SOURCE_DIR}/deploy/debian/copyright ${folder}/copyright)
  axisgate_package_copy(${component} ${CMAKE_SOURCE_DIR}/CHANGELOG.md ${folder}/changelog.gz)
  # The entry of this very package: its version and time are known when it is made.
  axisgate_package_file(${component} ${folder}/changelog.Debian.gz "
      set(PACKAGE ${package})
      set(VERSION ${PROJECT_VERSION})
      include(\"\${FOLDER}/changelog.cmake\")")
endfunction()

# A program's manual page and completion: it prints them itself (gateway/manual), so they say what its --help says.
function(axisgate_package_manual component program)
  set(man share/man/man1/${program}.1.gz)
  set(bash share/bash-completion/completions/${program})
  set(zsh share/zsh/vendor-completions/_${program})
  foreach(form man bash zsh)
    axisgate_package_file(${component} ${${form}}
      "execute_process(COMMAND \"$<TARGET_FILE:${program}>\" --generate ${form} OUTPUT_FILE \"\${FILE}\" COMMAND_ERROR_IS_FATAL ANY)")
  endforeach()
endfunction()

function(axisgate_package component program)
  axisgate_package_documents(${component} ${program})
  axisgate_package_manual(${component} ${program})
  set_property(GLOBAL APPEND PROPERTY AXISGATE_PACKAGES ${component})
endfunction()

axisgate_package(gateway axisgate)
axisgate_package_file(gateway share/man/man5/gateway.json.5.gz
  "execute_process(COMMAND \"$<TARGET_FILE:axisgate>\" --generate gateway.json OUTPUT_FILE \"\${FILE}\" COMMAND_ERROR_IS_FATAL ANY)")
set(files ${CMAKE_SOURCE_DIR}/deploy)
install(FILES ${files}/systemd/axisgate.service DESTINATION /lib/systemd/system COMPONENT gateway EXCLUDE_FROM_ALL)
install(FILES ${files}/udev/71-axisgate-lines.rules DESTINATION /lib/udev/rules.d COMPONENT gateway EXCLUDE_FROM_ALL)
# What a person decides is no more than an example: a package that brought a bus up, or a gateway, could move a motor.
install(FILES ${files}/example/gateway.json ${files}/udev/70-axisgate.rules ${files}/can/80-can0.network
        DESTINATION share/doc/axisgate/examples COMPONENT gateway EXCLUDE_FROM_ALL)
# The manual in the folders that it has here, so that its links lead somewhere in the package as well.
set(manual share/doc/axisgate)
install(FILES ${CMAKE_SOURCE_DIR}/README.md ${CMAKE_SOURCE_DIR}/SECURITY.md ${CMAKE_SOURCE_DIR}/CHANGELOG.md
        DESTINATION ${manual} COMPONENT gateway EXCLUDE_FROM_ALL)
foreach(name README.md register-map.md gateway.schema.json)
  install(FILES ${CMAKE_SOURCE_DIR}/schemas/${name} DESTINATION ${manual}/schemas COMPONENT gateway EXCLUDE_FROM_ALL)
endforeach()
install(FILES ${files}/example/gateway.json DESTINATION ${manual}/deploy/example COMPONENT gateway EXCLUDE_FROM_ALL)
install(FILES ${files}/can/80-can0.network DESTINATION ${manual}/deploy/can COMPONENT gateway EXCLUDE_FROM_ALL)
install(FILES ${files}/kubernetes/cells.json DESTINATION ${manual}/deploy/kubernetes COMPONENT gateway EXCLUDE_FROM_ALL)
install(FILES ${files}/kubernetes/cells/lift.json ${files}/kubernetes/cells/press.json DESTINATION ${manual}/deploy/kubernetes/cells COMPONENT gateway EXCLUDE_FROM_ALL)
install(PROGRAMS ${files}/kubernetes/render DESTINATION ${manual}/deploy/kubernetes COMPONENT gateway EXCLUDE_FROM_ALL)
install(FILES ${files}/compose.yaml DESTINATION ${manual}/deploy COMPONENT gateway EXCLUDE_FROM_ALL)
install(FILES ${files}/container/compose.json DESTINATION ${manual}/deploy/container COMPONENT gateway EXCLUDE_FROM_ALL)
install(PROGRAMS ${files}/container/cell DESTINATION ${manual}/deploy/container COMPONENT gateway EXCLUDE_FROM_ALL)
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs DESTINATION ${manual} COMPONENT gateway EXCLUDE_FROM_ALL FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.svg")
install(FILES ${files}/plc/axisgate.st ${files}/plc/axisgate.xml ${files}/plc/example.st ${files}/plc/example_least.st ${files}/plc/example_plain.st
        DESTINATION ${manual}/deploy/plc COMPONENT gateway EXCLUDE_FROM_ALL)
install(FILES ${files}/examples/README.md DESTINATION ${manual}/deploy/examples COMPONENT gateway EXCLUDE_FROM_ALL)
foreach(folder modbus new_drive panels node-red ros2)
  file(GLOB examples LIST_DIRECTORIES false CONFIGURE_DEPENDS ${files}/examples/${folder}/*)
  install(FILES ${examples} DESTINATION ${manual}/deploy/examples/${folder} COMPONENT gateway EXCLUDE_FROM_ALL)
endforeach()
install(DIRECTORY ${files}/examples/dds/ DESTINATION ${manual}/deploy/examples/dds COMPONENT gateway EXCLUDE_FROM_ALL PATTERN __pycache__ EXCLUDE)
# What is the sources' alone: its links become words.
install(CODE "set(MANUAL \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${manual}\")
include(\"${files}/debian/links.cmake\")" COMPONENT gateway EXCLUDE_FROM_ALL)
install(DIRECTORY DESTINATION /etc/axisgate COMPONENT gateway EXCLUDE_FROM_ALL)

if(TARGET axisgate-dds)
  axisgate_package(dds axisgate-dds)
  install(FILES ${files}/firewall/axisgate-dds.nft DESTINATION share/doc/axisgate-dds/examples COMPONENT dds EXCLUDE_FROM_ALL)
  install(DIRECTORY ${files}/examples/dds/ DESTINATION share/doc/axisgate-dds/examples COMPONENT dds EXCLUDE_FROM_ALL PATTERN __pycache__ EXCLUDE)
endif()
if(TARGET axisgate-web)
  axisgate_package(web axisgate-web)
  install(FILES ${files}/monitoring/prometheus.yml ${files}/monitoring/rules.yml ${files}/monitoring/dashboard.json ${files}/monitoring/alertmanager.yml
          DESTINATION share/axisgate/monitoring COMPONENT web EXCLUDE_FROM_ALL)
endif()
if(TARGET axisgate-sim)
  axisgate_package(simulator axisgate-sim)
endif()

set(CPACK_GENERATOR DEB)
get_property(CPACK_COMPONENTS_ALL GLOBAL PROPERTY AXISGATE_PACKAGES)
set(CPACK_PACKAGE_NAME axisgate)
set(CPACK_PROJECT_CONFIG_FILE ${CMAKE_SOURCE_DIR}/deploy/debian/cpack.cmake)
# Files outside /usr as well.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS})
include(CPack)
