# SPDX-License-Identifier: BSD-3-Clause
# What is installed where, and as which Debian packages (scripts/packages calls cpack). Dependencies are written out, not computed, so that
# they are the same for a cross build; tests/packages/on_bare_debian shows that none is missing.

set(units_dir lib/systemd/system) # below /usr: Debian 12 has no other place for it
set(systemd_dir "${PROJECT_SOURCE_DIR}/config/systemd")
set(libexec_dir libexec/ladder)

# --- ladder-robot: the services ---
install(TARGETS sensor_service_main gng_service_main ladder_service_main climb_controller_main
        RUNTIME DESTINATION ${libexec_dir} COMPONENT robot)
install(TARGETS ladder_command_main ladder_drive_check RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT robot)
foreach(unit ladder.target ladder-net.service ladder-net@.service ladder-sensor.service ladder-gng.service ladder-ladder.service
             ladder-climb.service)
  install(FILES "${systemd_dir}/${unit}" DESTINATION ${units_dir} COMPONENT robot)
endforeach()
install(FILES "${systemd_dir}/60-ladder.conf" DESTINATION lib/sysctl.d COMPONENT robot)
install(FILES "${systemd_dir}/60-ladder.rules" DESTINATION lib/udev/rules.d COMPONENT robot)
install(FILES "${systemd_dir}/sysusers.conf" DESTINATION lib/sysusers.d RENAME ladder.conf COMPONENT robot)
install(FILES "${systemd_dir}/environment" DESTINATION /etc/default RENAME ladder COMPONENT robot)
install(FILES config/robot.toml DESTINATION /etc/ladder COMPONENT robot)
install(FILES README.md LICENSE CHANGELOG.md docs/OPERATION.md docs/SAFETY.md docs/FRAMES.md config/leg_servos.dbc
        DESTINATION share/doc/ladder-robot COMPONENT robot)

# --- ladder-robot-simulator: what plays robot, ladder and sensors ---
if(TARGET ladder_simulator)
  install(TARGETS ladder_simulator ladder_score ladder_plant_main RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT simulator)
  install(FILES config/sim.toml DESTINATION share/ladder/config COMPONENT simulator)
endif()

# --- ladder-robot-tools: logs and the computer itself; the same layout below share/ladder as in the repository ---
install(TARGETS ladder_replay RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT tools)
install(PROGRAMS scripts/ladder-log scripts/ladder-doctor DESTINATION share/ladder/scripts COMPONENT tools)
install(DIRECTORY scripts/ladder_scripts DESTINATION share/ladder/scripts COMPONENT tools FILES_MATCHING PATTERN "*.py")
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/links")
foreach(tool ladder-log ladder-doctor)
  file(CREATE_LINK ../share/ladder/scripts/${tool} "${PROJECT_BINARY_DIR}/links/${tool}" SYMBOLIC)
  install(FILES "${PROJECT_BINARY_DIR}/links/${tool}" DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT tools)
endforeach()

# --- ladder-robot-spy: lcm-spy with our types and pictures ---
if(LADDER_BUILD_JAR)
  install(PROGRAMS scripts/spy DESTINATION "${CMAKE_INSTALL_BINDIR}" RENAME ladder-spy COMPONENT spy)
endif()

# --- ladder-robot-viewer: what carries messages to people ---
install(TARGETS ladder_viewer_main ladder_relay_main RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT viewer)
install(DIRECTORY "${PROJECT_BINARY_DIR}/share/ladder/viewer" DESTINATION share/ladder COMPONENT viewer) # viewer/web/build
install(FILES "${systemd_dir}/ladder-viewer.service" "${systemd_dir}/ladder-relay.service" DESTINATION ${units_dir} COMPONENT viewer)

# --- ladder-msgs-dev: the message types for other programs ---
file(GLOB message_types CONFIGURE_DEPENDS lcmtypes/*.lcm)
install(FILES ${message_types} lcmtypes/README.md DESTINATION share/ladder/lcmtypes COMPONENT msgs)
install(DIRECTORY "${PROJECT_BINARY_DIR}/lcmtypes/ladder_msgs" DESTINATION include COMPONENT msgs
        FILES_MATCHING PATTERN "*_t.hpp")
install(DIRECTORY "${PROJECT_BINARY_DIR}/lcmtypes/python/ladder_msgs" DESTINATION lib/python3/dist-packages COMPONENT msgs
        FILES_MATCHING PATTERN "*.py")

# --- Debian ---
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "the ladder robot project")
set(CPACK_PACKAGE_CONTACT "the ladder robot project <ladder-robot@localhost>")
set(CPACK_PACKAGE_VERSION "${PROJECT_VERSION}")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_SET_DESTDIR ON) # /etc does not lie below the prefix
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL robot tools viewer msgs ddgng)
if(TARGET ladder_simulator)
  list(APPEND CPACK_COMPONENTS_ALL simulator)
endif()
if(LADDER_BUILD_JAR)
  list(APPEND CPACK_COMPONENTS_ALL spy)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_HOMEPAGE "https://lcm-proj.github.io/")
if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
endif()

# ladder_deb(COMPONENT NAME SECTION "one line" "dependencies")
macro(ladder_deb component name section summary depends)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section})
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${summary}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${depends}")
endmacro()
set(runtime_depends "libc6 (>= 2.36), libgcc-s1, libstdc++6 (>= 12), liblcm1")
set(service_depends "${runtime_depends}, libfmt9, libspdlog1.10, libsystemd0, libtomlplusplus3, libhwy1")
ladder_deb(robot ladder-robot misc "services of a ladder-climbing robot: depth heads to grasps to servos"
           "${service_depends}, libgpiod2, systemd, iproute2")
ladder_deb(simulator ladder-robot-simulator misc "simulated sensors, drives and scenes for ladder-robot" "${runtime_depends}, libmujoco2.2.2")
ladder_deb(tools ladder-robot-tools misc "ladder-log and ladder-doctor: logs and the computer that ladder-robot runs on"
           "${service_depends}, python3 (>= 3.11), iproute2, ladder-msgs-dev (= ${PROJECT_VERSION})")
ladder_deb(viewer ladder-robot-viewer misc "web viewer of ladder-robot, and a relay of its messages over TCP" "${runtime_depends}, libsystemd0")
ladder_deb(spy ladder-robot-spy misc "lcm-spy with the messages and pictures of ladder-robot" "default-jre, liblcm-java, libjchart2d-java")
ladder_deb(msgs ladder-msgs-dev devel "message types of ladder-robot for C++, Python and lcm-gen" "")
set(CPACK_DEBIAN_MSGS_PACKAGE_SUGGESTS "liblcm-dev")
ladder_deb(ddgng libddgng-dev libdevel "growing neural gas with dynamic density (find_package(ddgng))" "libeigen3-dev, libhwy-dev, pkgconf | pkg-config")
set(CPACK_DEBIAN_ROBOT_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/config/debian/postinst;${PROJECT_SOURCE_DIR}/config/debian/prerm;${PROJECT_SOURCE_DIR}/config/debian/postrm;${PROJECT_SOURCE_DIR}/config/debian/conffiles")
include(CPack)
