# Every library from outside, all packaged by the distribution (deploy/install-deps installs them).
find_package(Threads REQUIRED)
find_package(OpenSSL REQUIRED)     # named by Cyclone DDS's targets
find_package(fastcdr REQUIRED)
find_package(fastrtps REQUIRED)
find_package(CycloneDDS REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(spdlog REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(GTest REQUIRED)
find_package(PNG REQUIRED)
find_package(benchmark REQUIRED)
find_program(ECITON_FASTDDSGEN fastddsgen REQUIRED)
find_program(ECITON_IDLC idlc REQUIRED)

# These packages bring no CMake files.
find_path(ECITON_SYSTEMD_INCLUDE systemd/sd-daemon.h REQUIRED)
find_library(ECITON_SYSTEMD_LIBRARY systemd REQUIRED)
add_library(eciton_systemd INTERFACE)
target_include_directories(eciton_systemd SYSTEM INTERFACE ${ECITON_SYSTEMD_INCLUDE})
target_link_libraries(eciton_systemd INTERFACE ${ECITON_SYSTEMD_LIBRARY})

find_path(ECITON_MUJOCO_INCLUDE mujoco/mujoco.h REQUIRED)
find_library(ECITON_MUJOCO_LIBRARY mujoco REQUIRED)
add_library(eciton_mujoco INTERFACE)
target_include_directories(eciton_mujoco SYSTEM INTERFACE ${ECITON_MUJOCO_INCLUDE})
target_link_libraries(eciton_mujoco INTERFACE ${ECITON_MUJOCO_LIBRARY})
