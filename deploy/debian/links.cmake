# SPDX-License-Identifier: Apache-2.0
# In the pages below MANUAL: links to what only the sources have become words, so that no link of the installed manual is dead. What is
# named here is of use to nobody without the sources; a page that links to anything else must have it installed
# (deploy/package.cmake), which tests/packages/debs_test.py holds.
set(of_the_sources "(\\.\\./)*(ARCHITECTURE\\.md|CONTRIBUTING\\.md|LICENSE|tests/|gateway/|adapters/)[^)]*")
file(GLOB_RECURSE pages "${MANUAL}/*.md")
foreach(page ${pages})
  file(READ "${page}" text)
  string(REGEX REPLACE "\\[([^]\n]+)\\]\\(${of_the_sources}\\)" "\\1 (in the sources)" changed "${text}")
  if(NOT changed STREQUAL text)
    file(WRITE "${page}" "${changed}")
  endif()
endforeach()
