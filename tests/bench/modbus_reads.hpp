// FC 3 reads per second of our server against a bare Asio echo server with the same payload sizes, in turns in one run.
// Promises the ratio beside both rates. Never judges: the goal (90 %) stands in the output, the reader compares.
#pragma once

namespace axisgate::bench {

struct ReadsOptions {
  int rounds = 25;  ///< of which the median counts
  int round_ms = 200;
};
void modbus_reads(const ReadsOptions& options);

}  // namespace axisgate::bench
