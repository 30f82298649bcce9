// SPDX-License-Identifier: GPL-3.0-or-later
#include "masks/mask_json.h"

#include <gtest/gtest.h>

#include <string>

#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace hullslam {
namespace {

class MaskJson : public ::testing::Test {
 protected:
  // Returns "section index value" for each record.
  std::vector<std::string> Records(const std::string& json) const {
    const std::filesystem::path path = folder_.Write("file.json", json);
    std::vector<std::string> records;
    ForEachJsonRecord(path, [&](const JsonRecord& record) {
      records.push_back(record.section + ' ' + std::to_string(record.index) + ' ' +
                        record.value.dump());
    });
    return records;
  }
  void ExpectRefusal(const std::string& json, const std::vector<std::string>& parts) const {
    ExpectInputError([&] { Records(json); }, parts);
  }

  TemporaryFolder folder_;
};

TEST_F(MaskJson, VisitsTheRecordsOfAList) {
  EXPECT_EQ(Records(R"([{"a": [{"b": 1}]}, 7, {"c": {}}])"),
            (std::vector<std::string>{R"( 0 {"a":[{"b":1}]})", R"( 1 {"c":{}})"}));
  EXPECT_TRUE(Records("[]").empty());
}

TEST_F(MaskJson, VisitsTheRecordsOfListsInAnObject) {
  EXPECT_EQ(Records(R"({"x": [{"a": 1}, {"a": 2}], "y": 3, "z": [{"b": {"c": 4}}]})"),
            (std::vector<std::string>{R"(x 0 {"a":1})", R"(x 1 {"a":2})", R"(z 0 {"b":{"c":4}})"}));
}

TEST_F(MaskJson, ReportsWhereAFileIsNotJson) {
  ExpectRefusal("[{\"a\": 1},\n {\"a\" 2}]", {"file.json: is no valid JSON", "line 2, column"});
  ExpectRefusal("[{\"a\": 1}", {"is no valid JSON", "line 1"});
  ExpectRefusal("[1] 2", {"is no valid JSON"});
  ExpectRefusal(std::string("[\"\xff\"]"), {"is no valid JSON"});
}

TEST_F(MaskJson, RefusesTooLargeFiles) {
  ExpectRefusal(std::string(100'000, '['), {"nested more than 16 deep"});
  std::string many = "[";
  for (int i = 0; i < 2'000'000; ++i) {
    many += "1,";
  }
  ExpectRefusal(many + "1]", {"more than 2000000 values"});
  many = "[";
  for (int i = 0; i < 1'000'000; ++i) {
    many += "{},";
  }
  ExpectRefusal(many + "{}]", {"more than 1000000 records"});
}

TEST_F(MaskJson, MessagesShortenLongValues) {
  ExpectRefusal("[\"" + std::string(100'000, 'a'), {"..."});
}

}  // namespace
}  // namespace hullslam
