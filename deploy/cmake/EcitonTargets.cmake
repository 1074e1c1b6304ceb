# How a library, a program and a test of Eciton are declared: one place for warnings, sanitizers and
# include paths. Every header is included from the root: "core/bus/reader.hpp".

add_library(eciton_build_options INTERFACE)
target_include_directories(eciton_build_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_options(eciton_build_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
  $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor -Woverloaded-virtual>
  $<$<BOOL:${ECITON_WERROR}>:-Werror>
  -ffp-contract=off)  # the same bits from every compiler flag set that may fuse
if(ECITON_SANITIZE)
  target_compile_options(eciton_build_options INTERFACE -fsanitize=${ECITON_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(eciton_build_options INTERFACE -fsanitize=${ECITON_SANITIZE})
endif()

# eciton_library(NAME SOURCES ... LINKS ...): a static library, or an interface one without sources.
function(eciton_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  if(arg_SOURCES)
    add_library(${name} STATIC ${arg_SOURCES})
    target_link_libraries(${name} PUBLIC eciton_build_options ${arg_LINKS})
  else()
    add_library(${name} INTERFACE)
    target_link_libraries(${name} INTERFACE eciton_build_options ${arg_LINKS})
  endif()
endfunction()

# eciton_program(NAME SOURCES ... LINKS ...)
function(eciton_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE eciton_build_options ${arg_LINKS})
endfunction()

# eciton_test(NAME SOURCES ... LINKS ... [TIMEOUT s] [LABELS ...] [SERIAL]): a GoogleTest program, one ctest each.
function(eciton_test name)
  cmake_parse_arguments(arg "SERIAL" "TIMEOUT" "SOURCES;LINKS;LABELS" ${ARGN})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE eciton_build_options ${arg_LINKS} GTest::gtest GTest::gtest_main)
  add_test(NAME ${name} COMMAND ${name})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  set_tests_properties(${name} PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS "${arg_LABELS}"
    ENVIRONMENT "ECITON_PLUGIN_PATH=${CMAKE_LIBRARY_OUTPUT_DIRECTORY}")
  if(arg_SERIAL)
    set_tests_properties(${name} PROPERTIES RUN_SERIAL ON)
  endif()
endfunction()
