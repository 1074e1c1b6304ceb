// From a module's config to the processes that run it.
#pragma once

#include "deploy/module_config.hpp"
#include "deploy/supervisor/launch.hpp"

namespace eciton::deploy {

/// `config_file` and `assignments` are handed to the processes; `programs` is where they are.
LaunchPlan plan_module(const ModuleConfig& config, const std::filesystem::path& config_file,
                       const std::vector<std::string>& assignments, const std::filesystem::path& programs);

/// Loads every vendor's plugin that the plans name, so that a missing one is found before anything starts.
Status check_vendors(const std::vector<LaunchPlan>& plans);

/// Ids, names and domains that two of the configs share are an Error naming both files.
Status check_distinct(const std::vector<ModuleConfig>& configs, const std::vector<std::string>& files);

}  // namespace eciton::deploy
