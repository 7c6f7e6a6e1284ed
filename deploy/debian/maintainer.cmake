# SPDX-License-Identifier: Apache-2.0
# Who makes these packages. Whoever else makes some puts AXISGATE_MAINTAINER="Name <address>" into the environment.
set(AXISGATE_MAINTAINER "axisgate maintainers <maintainers@axisgate.invalid>")
if(DEFINED ENV{AXISGATE_MAINTAINER})
  set(AXISGATE_MAINTAINER "$ENV{AXISGATE_MAINTAINER}")
endif()
