// SPDX-License-Identifier: Apache-2.0
// One request as it was read: what is asked for, and the few fields that are looked at.
// Promises that its bounds were kept. Never says whether it is answered.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate::web {

struct Request {
  enum class Method : std::uint8_t { get, head, other };
  Method method = Method::get;
  std::string target;  ///< as it was written: "/api/v1/axes?axes=1"
  bool keep_alive = true;
  bool body = false;  ///< one follows, of whatever length
  int hosts = 0;      ///< fields Host; one is right
  std::string host;
  std::string if_none_match;
  std::string last_event_id;
  bool takes_gzip = false;
  bool takes_chunks = true;  ///< of HTTP/1.1
};

}  // namespace axisgate::web
