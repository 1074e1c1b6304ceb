// Pixels as a PNG file's bytes, and bytes as text that a page can hold.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.hpp"

namespace eciton::report {

/// `rgb`: rows from the top, three bytes a pixel.
Result<std::string> png(int width, int height, std::span<const std::uint8_t> rgb);

std::string base64(const std::string& bytes);

}  // namespace eciton::report
