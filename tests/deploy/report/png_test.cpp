// What is written is read back by libpng's own reader; base64 has published cases.
#include "deploy/report/png.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <vector>

namespace eciton::report {
namespace {

TEST(PngTest, ReadsBackToTheSamePixels) {
  std::vector<std::uint8_t> pixels;
  for (int i = 0; i < 3 * 7 * 5; ++i) pixels.push_back(static_cast<std::uint8_t>(i * 37));
  const Result<std::string> file = png(7, 5, pixels);
  ASSERT_TRUE(file.ok());
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_memory(&image, file->data(), file->size()));
  EXPECT_EQ(image.width, 7u);
  EXPECT_EQ(image.height, 5u);
  image.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> back(PNG_IMAGE_SIZE(image));
  ASSERT_TRUE(png_image_finish_read(&image, nullptr, back.data(), 0, nullptr));
  EXPECT_EQ(back, pixels);
}

TEST(PngTest, RefusesPixelsThatDoNotFit) {
  EXPECT_FALSE(png(7, 5, std::vector<std::uint8_t>(104)).ok());
  EXPECT_FALSE(png(0, 5, std::vector<std::uint8_t>()).ok());
}

TEST(Base64Test, GivesTheCasesOfRfc4648) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xef"), "/+8=");
}

}  // namespace
}  // namespace eciton::report
