// SPDX-License-Identifier: Apache-2.0
// Samples of the gateway, of its buses, and of axisgate-web itself.
// Promises each as it was reported last. Never looks whether the gateway is joined: whoever calls it does.
#pragma once

#include "gateway/upstream/web_process/http/served.hpp"
#include "gateway/upstream/web_process/metrics/families.hpp"
#include "gateway/upstream/web_process/picture/picture.hpp"

namespace axisgate::web {

void add_gateway(Families& to, const Picture& picture);
void add_buses(Families& to, const Picture& picture);
void add_web(Families& to, const Picture& picture, const Served& served);

}  // namespace axisgate::web
