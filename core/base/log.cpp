// Sets up spdlog once per process.
#include "core/base/log.hpp"

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <string>

namespace eciton {

void start_log(std::string_view process, std::string_view level) {
  // A full queue drops the oldest line rather than block the caller.
  auto logger = spdlog::create_async_nb<spdlog::sinks::stderr_color_sink_mt>(std::string(process));
  logger->set_pattern("%H:%M:%S.%e %n %^%l%$ %v");
  spdlog::set_default_logger(std::move(logger));
  spdlog::set_level(spdlog::level::from_str(std::string(level)));
}

}  // namespace eciton
