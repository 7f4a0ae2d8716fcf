// SPDX-FileCopyrightText: 2026 The Oort authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <clocale>
#include <string>
#include <vector>

#include "oort/geometry/errors.hpp"
#include "oort/parameters/parameter_file.hpp"
#include "oort/parameters/table.hpp"
#include "storage_fixtures.hpp"

namespace oort {
namespace {

using testing::TemporaryFolder;
using testing::write_file;

class ParameterFile : public ::testing::Test {
 protected:
  Parameters read(const std::string& text, std::vector<std::string>* warnings = nullptr) {
    write_file(path(), text);
    return read_parameters(path(), warnings);
  }

  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const ParameterError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.rfind(path(), 0), 0u) << message;
      return message.substr(path().size());
    }
    return "";
  }

  std::string path() const { return (folder_.path() / "my.json").string(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(ParameterFile, TakesTheLibertiesOfTheDocumentation) {
  for (const char* text :
       {R"({"linear_update": 0.5, "output_map": {"robot_radius": 0.25}})",
        "# one\n{ \"linear_update\": 5e-1 // two\n$ three \"\n\"output_map\": {\"robot_radius\": 25E-2,},}",
        "\xEF\xBB\xBF{\"linear_update\": 9 \"linear_update\": 0.5 \"output_map\": {\"robot_radius\": 0.25}}"}) {
    const Parameters parameters = read(text);
    EXPECT_EQ(parameters.linear_update, 0.5) << text;
    EXPECT_EQ(parameters.output_map.robot_radius, 0.25) << text;
  }
}

TEST_F(ParameterFile, TellsOfKeysThatAreGivenTwice) {
  std::vector<std::string> warnings;
  read("{\"linear_update\": 9,\n\"linear_update\": 0.5}", &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], path() + ":2: linear_update was given in line 1; this one counts");
}

TEST_F(ParameterFile, UnescapesTexts) {
  EXPECT_EQ(read(R"({"map_frame": "a\"\\\/\n\u00e9\u20ac\ud83d\ude00"})").map_frame, "a\"\\/\n\u00e9\u20ac\U0001F600");
  for (const char* bad : {R"("\x")", R"("\u12")", R"("\ud83d")", R"("\ude00")", "\"\t\""}) {
    EXPECT_NE(refusal(std::string("{\"map_frame\": ") + bad + "}").find(":1: bad string"), std::string::npos) << bad;
  }
}

TEST_F(ParameterFile, NamesTheLineTheKeyAndTheNearestKnownOne) {
  EXPECT_EQ(refusal("{\n\"linear_updat\": 1}"),
            ":2: unknown parameter \"linear_updat\"; the nearest known is \"linear_update\"");
  EXPECT_EQ(refusal("{\"output_map\": 3}"), ":1: output_map: is a section; it takes { }, not one value");
  EXPECT_EQ(refusal("{\"linear_update\": {}}"), ":1: linear_update: takes one value (number), not a section { }");
  EXPECT_EQ(refusal("{\"linear_update\": null}"),
            ":1: expected the value of linear_update: true, false, a number, a \"text\" or {, found null");
  EXPECT_EQ(refusal("{\"output_map\": {\"median\": {\"kernel_size\": 4}}}"),
            ": output_map.median: kernel_size must be odd");
}

TEST_F(ParameterFile, NumbersDoNotDependOnTheLocale) {
  const std::string before = std::setlocale(LC_NUMERIC, nullptr);
  if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") == nullptr) std::setlocale(LC_NUMERIC, "C.UTF-8");
  EXPECT_EQ(read("{\"linear_update\": 0.5}").linear_update, 0.5);
  std::setlocale(LC_NUMERIC, before.c_str());
}

TEST_F(ParameterFile, FilesThatCannotBeReadAreNamed) {
  EXPECT_THROW(read_parameters(path() + ".none"), ParameterError);
  EXPECT_THROW(read_parameters("/"), ParameterError);
  EXPECT_THROW(read("\xFF\xFE{}"), ParameterError);
}

}  // namespace
}  // namespace oort
