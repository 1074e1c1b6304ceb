// The IDL text in each type's traits stands alone: both vendors' compilers read it, and our generator finds
// the same type in it again.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "idl/all.hpp"
#include "idl/every_kind.hpp"
#include "tests/idl/command.hpp"

namespace eciton::bus {
namespace {

namespace fs = std::filesystem;

struct Text {
  std::string type;
  std::string stem;  // of files: the type's name without colons
  std::string idl;
};

template <class... T>
void append_texts(std::vector<Text>& texts, std::type_identity<std::tuple<T...>>) {
  (texts.push_back({std::string(TypeTraits<T>::name), "", std::string(TypeTraits<T>::idl)}), ...);
}

std::vector<Text> all_texts() {
  std::vector<Text> texts;
  append_texts(texts, std::type_identity<msg::AllTypes>{});
  append_texts(texts, std::type_identity<std::tuple<eciton_test::wide::EveryKind, eciton_test::Vector>>{});
  for (Text& text : texts) {
    for (const char c : text.type) text.stem += c == ':' ? '_' : c;
  }
  return texts;
}

Outcome compile_by_cyclone(const fs::path& file, const fs::path& output_dir) {
  return run_command("'" ECITON_IDLC "' -l c -o '" + output_dir.string() + "' '" + file.string() + "'");
}

Outcome compile_by_fastdds(const fs::path& file, const fs::path& output_dir) {
  return run_command("'" ECITON_FASTDDSGEN "' -cs -replace -d '" + output_dir.string() + "' '" + file.string() + "'");
}

/// What a header says of one type.
std::string traits_of(const std::string& type, const std::string& header) {
  const std::size_t begin = header.find("struct eciton::bus::TypeTraits<::" + type + "> {");
  if (begin == std::string::npos) return "";
  return header.substr(begin, header.find("\n};\nstatic_assert", begin) - begin);
}

/// The header that declares a type: the one of all that specialises its traits.
std::string header_of(const std::string& type) {
  for (const char* directory : {ECITON_GENERATED_DIR "/idl", ECITON_TEST_GENERATED_DIR "/idl"}) {
    for (const auto& entry : fs::directory_iterator(directory)) {
      const std::string header = read_file(entry.path());
      if (!traits_of(type, header).empty()) return header;
    }
  }
  return "";
}

TEST(IdlTextTest, IsReadByCyclone) {
  const fs::path directory = fresh_directory("cyclone");
  for (const Text& text : all_texts()) {
    const fs::path file = directory / (text.stem + ".idl");
    write_file(file, text.idl);
    const Outcome outcome = compile_by_cyclone(file, directory);
    EXPECT_EQ(outcome.status, 0) << text.idl << outcome.output;
    EXPECT_TRUE(fs::exists(directory / (text.stem + ".h")));
  }
}

// All in one file, each in a module of its own: what takes fastddsgen its time is each file.
TEST(IdlTextTest, IsReadByFastDds) {
  const fs::path directory = fresh_directory("fastdds");
  const std::vector<Text> texts = all_texts();
  std::string idl;
  for (const Text& text : texts) idl += "module of_" + text.stem + " {\n" + text.idl + "};\n";
  write_file(directory / "all.idl", idl);
  const Outcome outcome = compile_by_fastdds(directory / "all.idl", directory);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  const std::string source = read_file(directory / "all.cxx");
  for (const Text& text : texts) {
    EXPECT_NE(source.find("of_" + text.stem + "::" + text.type + "::serialize("), std::string::npos) << text.type;
  }
}

TEST(IdlTextTest, GivesTheSameTypeAgain) {
  const fs::path directory = fresh_directory("again");
  for (const Text& text : all_texts()) {
    write_file(directory / (text.stem + ".idl"), text.idl);
    const Outcome outcome = generate(directory / (text.stem + ".idl"), directory);
    ASSERT_EQ(outcome.status, 0) << text.idl << outcome.output;
    const std::string again = traits_of(text.type, read_file(directory / (text.stem + ".hpp")));
    EXPECT_NE(again, "") << text.type;
    EXPECT_EQ(again, traits_of(text.type, header_of(text.type)));
  }
}

TEST(IdlTextTest, IsRefusedByBothWhenADependencyIsMissing) {
  const fs::path directory = fresh_directory("damaged");
  std::string idl(TypeTraits<msg::RotorCommand>::idl);
  const std::size_t begin = idl.find("  @nested @final struct Rotor {");
  idl.erase(begin, idl.find("};\n", begin) + 3 - begin);
  const fs::path file = directory / "damaged.idl";
  write_file(file, idl);
  EXPECT_NE(compile_by_cyclone(file, directory).status, 0);
  EXPECT_NE(compile_by_fastdds(file, directory).status, 0);
}

}  // namespace
}  // namespace eciton::bus
