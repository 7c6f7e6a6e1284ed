# SPDX-License-Identifier: Apache-2.0
# What the packages are called, what they say of themselves and what they need. Read by CPack when it makes them.
include("${CMAKE_CURRENT_LIST_DIR}/maintainer.cmake")
set(version ${CPACK_PACKAGE_VERSION})
if(DEFINED ENV{AXISGATE_PACKAGE_VERSION})
  set(version $ENV{AXISGATE_PACKAGE_VERSION})
endif()

set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${AXISGATE_MAINTAINER}")
set(CPACK_DEBIAN_PACKAGE_VERSION ${version})
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION net)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
# The libraries that the programs link, as dpkg-shlibdeps finds them.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_GATEWAY_PACKAGE_NAME axisgate)
set(CPACK_DEBIAN_GATEWAY_DESCRIPTION "gateway from motor drives on fieldbuses to Modbus-TCP
Drives on CANopen, Modbus RTU, Kinco's and Keya's own protocols appear as the
same axis: the same registers, units and commands, whatever the drive. A JSON
profile per drive type holds what is particular to it.

Nothing is started by the installation: the service axisgate.service wants a
configuration, /etc/axisgate/gateway.json, and somebody who enables it.

No function of this program is a safety function.")
set(CPACK_DEBIAN_GATEWAY_PACKAGE_DEPENDS "adduser")
set(CPACK_DEBIAN_GATEWAY_PACKAGE_SUGGESTS "axisgate-web, axisgate-dds, axisgate-sim")
set(CPACK_DEBIAN_GATEWAY_PACKAGE_CONTROL_EXTRA "${CMAKE_CURRENT_LIST_DIR}/postinst;${CMAKE_CURRENT_LIST_DIR}/prerm;${CMAKE_CURRENT_LIST_DIR}/postrm")

# The gateway and each of the two speak records of one version to each other.
set(CPACK_DEBIAN_DDS_PACKAGE_NAME axisgate-dds)
set(CPACK_DEBIAN_DDS_DESCRIPTION "DDS and ROS 2 topics of axisgate
The gateway axisgate starts this program where its configuration has a \"dds\"
section. Every axis is a topic then, for DDS and ROS 2 programs.")
set(CPACK_DEBIAN_DDS_PACKAGE_DEPENDS "axisgate (= ${version}-1)")

set(CPACK_DEBIAN_WEB_PACKAGE_NAME axisgate-web)
set(CPACK_DEBIAN_WEB_DESCRIPTION "page and API of axisgate
The gateway axisgate starts this program where its configuration has a \"web\"
section. It shows every axis, bus and event in a browser, and commands nothing.")
set(CPACK_DEBIAN_WEB_PACKAGE_DEPENDS "axisgate (= ${version}-1)")

set(CPACK_DEBIAN_SIMULATOR_PACKAGE_NAME axisgate-sim)
set(CPACK_DEBIAN_SIMULATOR_DESCRIPTION "simulated motor drives on pseudo-terminals and CAN interfaces
Kinco, Leadshine, iD286pro and Keya drives as their makers' manuals describe
them, for trying a configuration of the gateway axisgate at a desk.")
set(CPACK_DEBIAN_SIMULATOR_PACKAGE_SUGGESTS "axisgate")
