# SPDX-License-Identifier: Apache-2.0
# The entry of PACKAGE for this version, as the file FILE. SOURCE_DATE_EPOCH is its time, so that one source gives one package.
if(DEFINED ENV{AXISGATE_PACKAGE_VERSION})
  set(VERSION $ENV{AXISGATE_PACKAGE_VERSION})
endif()
include("${FOLDER}/maintainer.cmake")
string(TIMESTAMP time "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(WRITE "${FILE}" "${PACKAGE} (${VERSION}-1) unstable; urgency=medium

  * Version ${VERSION}: see changelog.gz beside this file.

 -- ${AXISGATE_MAINTAINER}  ${time}
")
