// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/http/request_reader.hpp"

#include "gateway/upstream/web_process/http/header_parser.hpp"

namespace axisgate::web {

void RequestReader::received(std::string_view bytes, SteadyNs now) {
  if (bytes_.empty() && !bytes.empty()) since_ = now;
  bytes_ += bytes;
}

std::optional<Refusal> RequestReader::look() {
  constexpr std::size_t kEnd = 2;  // CR LF
  while (header_ == 0) {
    const std::size_t end = bytes_.find('\n', looked_);
    const std::size_t here = end == std::string::npos ? bytes_.size() : end;
    // In the order in which a reader of single bytes meets them.
    if (lines_ == 0 && here - line_ >= kMaxRequestLine + kEnd) return Refusal::long_request_line;
    if (here >= kMaxHeader) return Refusal::large_header;
    looked_ = here;
    if (end == std::string::npos) return std::nullopt;
    if (end == line_ || bytes_[end - 1] != '\r') return Refusal::malformed;
    const bool empty = end == line_ + 1;
    if (empty && lines_ == 0) return Refusal::malformed;
    looked_ = line_ = end + 1;
    if (empty) header_ = line_;
    if (!empty && ++lines_ > kMaxFields + 1) return Refusal::large_header;
  }
  return std::nullopt;
}

std::optional<RequestReader::Read> RequestReader::next() {
  if (const auto refusal = look()) return *refusal;
  if (header_ == 0) return std::nullopt;
  std::optional<Request> request = parse_header(std::string_view(bytes_).substr(0, header_));
  bytes_.erase(0, header_);
  line_ = looked_ = lines_ = header_ = 0;
  if (!request) return Refusal::malformed;
  if (request->method == Request::Method::other) return Refusal::method;
  if (request->body) return Refusal::body;
  if (request->hosts != 1) return Refusal::malformed;
  return *request;
}

}  // namespace axisgate::web
