// SPDX-License-Identifier: Apache-2.0
// A client at a socket of its own: bytes out, answers in. What it is not sent it waits for, as long as a test's
// patience.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::web::test {

struct Answered {
  unsigned status = 0;  ///< 0: the connection was closed without an answer
  std::string header;
  std::string body;
};

class Client {
 public:
  /// @param receive_buffer of the system's, bytes; 0: as it likes
  explicit Client(std::uint16_t port, int receive_buffer = 0);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  /// False: the other side is gone.
  bool send(std::string_view bytes);
  /// The next answer, with its body.
  [[nodiscard]] Answered answer();
  /// The body of an answer that comes in chunks, put together, as far as it came.
  struct Whole {
    std::string body;
    bool complete = false;
  };
  [[nodiscard]] Whole chunks();
  /// A GET and its answer.
  [[nodiscard]] Answered get(const std::string& target, const std::string& fields = "");
  /// Data of the next such event of a stream; none: the stream has ended.
  [[nodiscard]] std::optional<nlohmann::json> event(const std::string& name);
  /// All that comes until the other side closes.
  [[nodiscard]] std::string rest();
  /// Until the other side closes: true.
  [[nodiscard]] bool closed();

 private:
  /// Reads on until this is there; nothing: the connection ended before. What it takes with the text at its end.
  std::optional<std::string> until(const std::string& text);
  /// False: there is nothing more.
  bool more();

  int socket_ = -1;
  std::string bytes_;
};

[[nodiscard]] std::string get_of(const std::string& target, const std::string& fields = "");

}  // namespace axisgate::web::test
