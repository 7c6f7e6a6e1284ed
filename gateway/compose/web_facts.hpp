// SPDX-License-Identifier: Apache-2.0
// What pages show of a configuration: its drives, its buses with what `axisgate check` reckons of them, and what its
// drives' fault words mean. Promises the figures of `axisgate check`. Never opens or asks anything: it is what was
// configured, not what is there.
#pragma once

#include "gateway/config/config_loader.hpp"
#include "gateway/upstream/web/web_facts.hpp"

namespace axisgate::compose {

[[nodiscard]] web::WebFacts web_facts(const config::LoadedConfig& loaded);

}  // namespace axisgate::compose
