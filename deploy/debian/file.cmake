# SPDX-License-Identifier: Apache-2.0
# Makes one file of a package: see axisgate_package_file in deploy/package.cmake.
set(FILE "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/${DESTINATION}")
get_filename_component(folder "${FILE}" DIRECTORY)
file(MAKE_DIRECTORY "${folder}")
string(REGEX REPLACE "\\.gz$" "" plain "${FILE}")
set(compressed "${FILE}")
set(FILE "${plain}")
make_file()
if(NOT plain STREQUAL compressed)
  # -n: the same text is the same file.
  execute_process(COMMAND "${GZIP}" -9 -n -f "${plain}" COMMAND_ERROR_IS_FATAL ANY)
endif()
file(CHMOD "${compressed}" PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
