# The entry of PACKAGE for this version, as the file MADE. SOURCE_DATE_EPOCH is its time, so that one source gives one package.
if(DEFINED ENV{AXISGATE_PACKAGE_VERSION})
  set(VERSION $ENV{AXISGATE_PACKAGE_VERSION})
endif()
include("${CMAKE_CURRENT_LIST_DIR}/maintainer.cmake")
string(TIMESTAMP time "%a, %d %b %Y %H:%M:%S +0000" UTC)
get_filename_component(folder "${MADE}" DIRECTORY)
file(MAKE_DIRECTORY "${folder}")
file(WRITE "${MADE}" "${PACKAGE} (${VERSION}-1) unstable; urgency=medium

  * Version ${VERSION}: see changelog.gz beside this file.

 -- ${AXISGATE_MAINTAINER}  ${time}
")
