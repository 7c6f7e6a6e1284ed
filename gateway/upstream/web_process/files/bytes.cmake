# SPDX-License-Identifier: Apache-2.0
# The bytes of FILE as a list of numbers in OUT, for an initializer.
function(bytes_of file out)
  file(READ ${file} hex HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," numbers "${hex}")
  set(${out} "${numbers}" PARENT_SCOPE)
endfunction()
