// The generator as a tool: the same output each time, nothing rewritten without need, and a refusal that
// names place, thing and remedy for whatever the wire contract excludes.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/idl/command.hpp"

namespace eciton {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> wire_contract() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(ECITON_IDL_DIR)) {
    if (entry.path().extension() == ".idl") files.push_back(entry.path());
  }
  return files;
}

TEST(GeneratorTest, WritesTheSameHeadersEachTime) {
  const fs::path first = fresh_directory("first");
  const fs::path second = fresh_directory("second/and/deeper");
  ASSERT_GE(wire_contract().size(), 9U);
  for (const fs::path& file : wire_contract()) {
    const fs::path header = file.stem().string() + ".hpp";
    ASSERT_EQ(generate(file, first).status, 0);
    ASSERT_EQ(generate(file, second).status, 0);
    EXPECT_FALSE(read_file(first / header).empty());
    EXPECT_EQ(read_file(first / header), read_file(second / header)) << header;
    EXPECT_EQ(read_file(first / header), read_file(fs::path(ECITON_GENERATED_DIR) / "idl" / header)) << header;
  }
}

TEST(GeneratorTest, LeavesAnUnchangedHeaderAlone) {
  const fs::path directory = fresh_directory("unchanged");
  const fs::path source = directory / "tick.idl";
  write_file(source, "module t {\n@final struct Tick { int64 stamp_ns; };\n};\n");
  ASSERT_EQ(generate(source, directory).status, 0);
  const auto long_ago = fs::last_write_time(directory / "tick.hpp") - std::chrono::hours(1);
  fs::last_write_time(directory / "tick.hpp", long_ago);
  ASSERT_EQ(generate(source, directory).status, 0);
  EXPECT_EQ(fs::last_write_time(directory / "tick.hpp"), long_ago);
  write_file(source, "module t {\n@final struct Tock { int64 stamp_ns; };\n};\n");
  ASSERT_EQ(generate(source, directory).status, 0);
  EXPECT_NE(read_file(directory / "tick.hpp").find("struct Tock"), std::string::npos);
}

TEST(GeneratorTest, ReplacesALongerHeaderByAShorterOne) {
  const fs::path directory = fresh_directory("shorter");
  write_file(directory / "tick.idl", "module t {\n@final struct Tick { int64 stamp_ns; };\n};\n");
  ASSERT_EQ(generate(directory / "tick.idl", directory).status, 0);
  const std::string header = read_file(directory / "tick.hpp");
  write_file(directory / "tick.hpp", header + "// left over\n");
  ASSERT_EQ(generate(directory / "tick.idl", directory).status, 0);
  EXPECT_EQ(read_file(directory / "tick.hpp"), header);
}

TEST(GeneratorTest, SaysWhereItCannotWrite) {
  const fs::path directory = fresh_directory("unwritable");
  write_file(directory / "tick.idl", "module t {\n@final struct Tick { int64 stamp_ns; };\n};\n");
  fs::create_directory(directory / "tick.hpp");  // a directory where the header would be
  const Outcome outcome = generate(directory / "tick.idl", directory);
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.output.find("tick.hpp: cannot be written"), std::string::npos) << outcome.output;
}

struct Refusal {
  const char* name;
  const char* idl;  // what stands in module `bad`, from line 2 on
  int line;
  const char* message;
};

// So that a failing case is named by its name, not by its bytes.
void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.name; }

class RefusalTest : public testing::TestWithParam<Refusal> {};

TEST_P(RefusalTest, NamesPlaceThingAndRemedy) {
  const fs::path directory = fresh_directory(std::string("refused/") + GetParam().name);
  write_file(directory / "case.idl", std::string("module bad {\n") + GetParam().idl + "\n};\n");
  const Outcome outcome = generate(directory / "case.idl", directory);
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.output.find("case.idl:" + std::to_string(GetParam().line) + ":"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find(GetParam().message), std::string::npos) << outcome.output;
  EXPECT_FALSE(fs::exists(directory / "case.hpp"));
}

const Refusal refusals[] = {
    Refusal{"NotFinal", "struct S { int64 stamp_ns; };", 2,
            "struct bad::S: is not @final; both DDS vendors understand each other only with @final"},
    Refusal{"Appendable", "@appendable struct S { int64 stamp_ns; };", 2, "struct bad::S: is not @final"},
    Refusal{"NestedNotFinal", "@nested struct S { long x; };", 2, "struct bad::S: is not @final"},
    Refusal{"NoStamp", "@final struct S { uint32 id; };", 2,
            "struct bad::S: a topic without a time; add `int64 stamp_ns;`"},
    Refusal{"StampOfAnotherType", "@final struct S { uint64 stamp_ns; };", 2,
            "struct bad::S: a topic without a time"},
    Refusal{"UnboundedString", "@final struct S { int64 stamp_ns;\n  string text;\n};", 3,
            "struct bad::S, member text: a string without a bound; write string<N>"},
    Refusal{"UnboundedSequence", "@final struct S { int64 stamp_ns;\n  sequence<double> x;\n};", 3,
            "struct bad::S, member x: a sequence without a bound; write sequence<T, N>"},
    Refusal{"UnboundedStringInSequence", "@final struct S { int64 stamp_ns;\n  sequence<string, 3> x;\n};", 3,
            "struct bad::S, member x: a string without a bound"},
    Refusal{"WideString", "@final struct S { int64 stamp_ns;\n  wstring x;\n};", 3, "syntax error"},
    Refusal{"WideCharacter", "@final struct S { int64 stamp_ns;\n  wchar x;\n};", 3,
            "struct bad::S, member x: a type that not both DDS vendors know; write a number"},
    Refusal{"LongDouble", "@final struct S { int64 stamp_ns;\n  long double x;\n};", 3,
            "struct bad::S, member x: a type that not both DDS vendors know"},
    Refusal{"Union", "@final union U switch (long) { case 1: long x; };", 2,
            "union U: is not in the wire contract; write an enum or structs"},
    Refusal{"Typedef", "typedef long Length;", 2,
            "typedef Length: is not in the wire contract; write the type itself where it is used"},
    Refusal{"Constant", "const long COUNT = 3;", 2,
            "const COUNT: is not in the wire contract; write the number itself where it is used"},
    Refusal{"Bitmask", "bitmask Flags { A, B };", 2, "bitmask Flags: is not in the wire contract"},
    Refusal{"ForwardDeclaration", "struct S;\n@final struct S { int64 stamp_ns; };", 2,
            "struct forward declaration S: is not in the wire contract; write the definition before its uses"},
    Refusal{"Inheritance", "@nested @final struct B { long x; };\n@final struct S : B { int64 stamp_ns; };", 3,
            "struct bad::S: inherits; write the members of the base here"},
    Refusal{"Optional", "@final struct S { int64 stamp_ns;\n  @optional double x;\n};", 3,
            "struct bad::S, member x: @optional is not in the wire contract"},
    Refusal{"MemberId", "@final struct S { int64 stamp_ns;\n  @id(7) double x;\n};", 3,
            "struct bad::S, member x: @id is not in the wire contract"},
    Refusal{"External", "@final struct S { int64 stamp_ns;\n  @external double x;\n};", 3,
            "struct bad::S, member x: @external is not in the wire contract"},
    Refusal{"KeyList", "struct S { int64 stamp_ns; };\n#pragma keylist S stamp_ns", 2,
            "struct bad::S: #pragma keylist; write @key before the members"},
    Refusal{"Empty", "@final struct S { };", 2, "struct bad::S: has no members"},
    Refusal{"Matrix", "@final struct S { int64 stamp_ns;\n  double R[3][3];\n};", 3,
            "struct bad::S, member R: an array of more than one dimension; write one, row by row"},
    Refusal{"SequenceOfSequences", "@final struct S { int64 stamp_ns;\n  sequence<sequence<long, 2>, 2> x;\n};", 3,
            "struct bad::S, member x: a sequence or array of sequences; put the inner one into a @nested struct"},
    Refusal{"ArrayOfSequences", "@final struct S { int64 stamp_ns;\n  sequence<long, 2> x[2];\n};", 3,
            "struct bad::S, member x: a sequence or array of sequences"},
    Refusal{"StructWithinItself", "@nested @final struct N {\n  sequence<N, 2> inner;\n};", 3,
            "struct bad::N, member inner: a struct within itself"},
    Refusal{"TopicAsMember",
            "@final struct T { int64 stamp_ns; };\n@final struct S { int64 stamp_ns;\n  T inner;\n};", 4,
            "struct bad::S, member inner: T is a topic of its own; only a @nested struct may be a member"},
    Refusal{"StringKey", "@final struct S {\n  @key string<7> who; int64 stamp_ns;\n};", 3,
            "struct bad::S, member who: a bounded string as key; use an integer or an enum"},
    Refusal{"StructKey", "@nested @final struct N { long x; };\n@final struct S {\n  @key N who; int64 stamp_ns;\n};",
            4, "struct bad::S, member who: a struct as key"},
    Refusal{"KeyInNestedStruct", "@nested @final struct N {\n  @key long x; };", 3,
            "struct bad::N, member x: a key in a @nested struct; keys stand in the topic itself"},
    Refusal{"KeyBehindAnotherMember", "@final struct S { @key int32 a; int64 stamp_ns;\n  @key int32 b;\n};", 3,
            "struct bad::S, member b: a key behind members that are none; keys come first"},
    Refusal{"LongKey", "@final struct S { @key int64 a; @key int64 b;\n  @key octet c; int64 stamp_ns;\n};", 3,
            "struct bad::S, member c: makes the key longer than 16 bytes"},
    Refusal{"LongKeyByAlignment",
            "@final struct S { @key octet a; @key int64 b;\n  @key int32 c; int64 stamp_ns;\n};", 3,
            "struct bad::S, member c: makes the key longer than 16 bytes"},
    Refusal{"TooLarge",
            "@nested @final struct N { string<1000> t[1000]; };\n@final struct S { int64 stamp_ns; sequence<N, "
            "4000000000> all; };",
            3, "struct bad::S: may serialize to more than 1048576 bytes; lower the bounds"},
    Refusal{"EnumeratorWithoutPrefix", "enum FlightMode { FLIGHT_MODE_HOVER,\n  LANDED };", 3,
            "enum bad::FlightMode, enumerator LANDED: does not begin with FLIGHT_MODE_ and a letter"},
    Refusal{"EnumeratorWithNothingAfterThePrefix", "enum Mode { MODE_ };", 2,
            "enumerator MODE_: does not begin with MODE_ and a letter"},
    Refusal{"EnumeratorWithValue", "enum Mode { MODE_A,\n  @value(5) MODE_B };", 3,
            "enum bad::Mode, enumerator MODE_B: has the value 5; values count from 0"},
    Refusal{"EnumOfAnotherSize", "@bit_bound(8) enum Mode { MODE_A };", 2,
            "enum bad::Mode: @bit_bound is not in the wire contract"},
    Refusal{"MemberNamedByKeyword", "@final struct S { int64 stamp_ns;\n  long class;\n};", 3,
            "struct bad::S, member class: the name is a keyword of C++; choose another"},
    Refusal{"ModuleNamedByKeyword", "module namespace { @final struct S { int64 stamp_ns; }; };", 2,
            "module namespace: the name is a keyword of C++; choose another"},
};

INSTANTIATE_TEST_SUITE_P(Contract, RefusalTest, testing::ValuesIn(refusals),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(GeneratorTest, AcceptsWhatTheRefusalsAskForInstead) {
  const fs::path directory = fresh_directory("accepted");
  write_file(directory / "case.idl",
             "module good {\n@nested @final struct N { sequence<long, 2> row; };\n"
             "@final struct S { @key int64 a; @key int32 b; @key octet c; int64 stamp_ns; string<7> who;\n"
             "  sequence<N, 2> rows; double R[9]; };\n};\n");
  const Outcome outcome = generate(directory / "case.idl", directory);
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_TRUE(fs::exists(directory / "case.hpp"));
}

TEST(GeneratorTest, ReportsAllRefusalsAtOnce) {
  const fs::path directory = fresh_directory("several");
  write_file(directory / "case.idl", "module bad {\n@final struct S { string a;\n sequence<long> b; };\n};\n");
  const std::string output = generate(directory / "case.idl", directory).output;
  EXPECT_NE(output.find("member a: a string"), std::string::npos) << output;
  EXPECT_NE(output.find("member b: a sequence"), std::string::npos) << output;
  EXPECT_NE(output.find("a topic without a time"), std::string::npos) << output;
}

TEST(GeneratorTest, RefusesATypeOutsideOfAnyModule) {
  const fs::path directory = fresh_directory("homeless");
  write_file(directory / "case.idl", "@final struct S { int64 stamp_ns; };\n");
  const Outcome outcome = generate(directory / "case.idl", directory);
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.output.find("S: stands outside of any module"), std::string::npos) << outcome.output;
}

}  // namespace
}  // namespace eciton
