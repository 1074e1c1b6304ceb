// Numbers of a length that people read.
#include "deploy/report/text.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace eciton::report {
namespace {

TEST(TextTest, FiguresHaveThreeDigitsAndCountsNone) {
  EXPECT_EQ(figure_text(20), "20");
  EXPECT_EQ(figure_text(-3), "-3");
  EXPECT_EQ(figure_text(12345), "12,345");
  EXPECT_EQ(figure_text(0.01714), "0.0171");
  EXPECT_EQ(figure_text(4.6612), "4.66");
  EXPECT_EQ(figure_text(NAN), "–");
}

TEST(TextTest, WhatMeansSomethingInAPageIsEscaped) {
  EXPECT_EQ(escaped("<a b='c' d=\"e\">&\x01"), "&lt;a b=&#39;c&#39; d=&quot;e&quot;&gt;&amp; ");
}

}  // namespace
}  // namespace eciton::report
