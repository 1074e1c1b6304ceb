// libpng with its best compression; the shades of a rendered still are few, so that true colour stays small.
#include "deploy/report/png.hpp"

#include <png.h>

#include <csetjmp>
#include <vector>

namespace eciton::report {
namespace {

void append(png_structp png_file, png_bytep bytes, png_size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png_file))->append(reinterpret_cast<const char*>(bytes), count);
}

void keep_nothing(png_structp) {}

/// Everything with a destructor lives in the caller: libpng leaves by longjmp.
bool write(png_structp file, png_infop info, int width, int height, png_bytepp rows, std::string* out) {
  if (setjmp(png_jmpbuf(file)) != 0) return false;
  png_set_write_fn(file, out, &append, &keep_nothing);
  png_set_IHDR(file, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(file, 9);
  png_write_info(file, info);
  png_write_image(file, rows);
  png_write_end(file, nullptr);
  return true;
}

}  // namespace

Result<std::string> png(int width, int height, std::span<const std::uint8_t> rgb) {
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  if (width <= 0 || height <= 0 || rgb.size() != row * static_cast<std::size_t>(height)) {
    return Error{"a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels with " +
                 std::to_string(rgb.size()) + " bytes; it takes three a pixel"};
  }
  // libpng takes rows that it could write to, and does not.
  std::vector<png_bytep> rows;
  for (std::size_t y = 0; y < rgb.size(); y += row) rows.push_back(const_cast<png_bytep>(rgb.data() + y));
  png_structp file = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = file == nullptr ? nullptr : png_create_info_struct(file);
  std::string out;
  const bool written = info != nullptr && write(file, info, width, height, rows.data(), &out);
  png_destroy_write_struct(&file, &info);
  if (!written) return Error{"libpng does not write a picture"};
  return out;
}

std::string base64(const std::string& bytes) {
  constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u; };
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const unsigned group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (std::size_t k = 0; k < 4; ++k) {
      out += i + k <= bytes.size() ? letters[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return out;
}

}  // namespace eciton::report
