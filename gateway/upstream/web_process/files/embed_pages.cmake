# SPDX-License-Identifier: Apache-2.0
# Every file below FROM, and the files LIBRARY as lib/NAME, as the C++ source TO: each with its type, its tag, and its bytes,
# compressed by GZIP too.
include(${CMAKE_CURRENT_LIST_DIR}/bytes.cmake)
set(types html=text/html css=text/css js=text/javascript mjs=text/javascript txt=text/plain json=application/json svg=image/svg+xml
  png=image/png ico=image/x-icon woff2=font/woff2 webmanifest=application/manifest+json)
file(GLOB_RECURSE names RELATIVE ${FROM} ${FROM}/*)
foreach(name ${names})
  set(path_${name} ${FROM}/${name})
endforeach()
foreach(path ${LIBRARY})
  get_filename_component(name ${path} NAME)
  list(APPEND names lib/${name})
  set(path_lib/${name} ${path})
endforeach()
list(SORT names)
set(bytes "")
set(rows "")
set(count 0)
foreach(name ${names})
  string(REGEX MATCH "[a-z0-9]+$" ending "${name}")
  set(type "")
  foreach(each ${types})
    if(each MATCHES "^${ending}=(.*)$")
      set(type "${CMAKE_MATCH_1}")
    endif()
  endforeach()
  if(NOT type)
    message(FATAL_ERROR "${path_${name}}: files/embed_pages.cmake has no type for this ending")
  endif()
  if(type MATCHES "^text/")
    string(APPEND type "; charset=utf-8")
  endif()
  file(SHA256 ${path_${name}} tag)
  string(SUBSTRING ${tag} 0 32 tag)
  execute_process(COMMAND ${GZIP} -9 -n -c ${path_${name}} OUTPUT_FILE ${TO}.gz COMMAND_ERROR_IS_FATAL ANY)
  file(SIZE ${path_${name}} plain_size)
  file(SIZE ${TO}.gz gzip_size)
  bytes_of(${path_${name}} plain)
  string(APPEND bytes "constexpr unsigned char kPlain${count}[] = {${plain}0};\n")
  set(gzip "{}")
  if(gzip_size LESS plain_size)
    bytes_of(${TO}.gz gzip)
    string(APPEND bytes "constexpr unsigned char kGzip${count}[] = {${gzip}0};\n")
    set(gzip "text_of(kGzip${count})")
  endif()
  string(APPEND rows "      {\"/${name}\", \"${type}\", \"W/\\\"${tag}\\\"\", text_of(kPlain${count}), ${gzip}},\n")
  math(EXPR count "${count} + 1")
endforeach()
file(REMOVE ${TO}.gz)
file(WRITE ${TO} "// Made from the files of pages.
#include <vector>
#include \"gateway/upstream/web_process/files/files.hpp\"
namespace axisgate::web {
namespace {
${bytes}
template <std::size_t Size>
std::string_view text_of(const unsigned char (&bytes)[Size]) {
  return {reinterpret_cast<const char*>(bytes), Size - 1};
}
}
std::span<const File> files() {
  static const std::vector<File> kFiles{
${rows}  };
  return kFiles;
}
}
")
