// SPDX-License-Identifier: GPL-3.0-or-later
#include "map_files/vocabulary_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include "bow/vocabulary_builder.h"
#include "hullslam/util/error.h"
#include "util/text.h"

namespace hullslam {
namespace {

constexpr size_t kDescriptorBytes = 32;
constexpr size_t kNodeColumns = kDescriptorBytes + 3;

// Reads a text line by line, and each line column by column.
class LineReader {
 public:
  LineReader(std::string_view text, const std::filesystem::path& path) : rest_(text), path_(path) {}

  // Goes to the next line. Returns false if only white space is left.
  bool Next() {
    ++line_;
    const size_t end = rest_.find('\n');
    columns_ = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    return !AtEnd() || rest_.find_first_not_of(" \t\r\n") != std::string_view::npos;
  }

  [[noreturn]] void Fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_.string(), line_, what));
  }

  // Whether the line has no further column.
  bool AtEnd() {
    const size_t first = columns_.find_first_not_of(" \t\r");
    columns_.remove_prefix(std::min(first, columns_.size()));
    return columns_.empty();
  }

  // The next column of the line.
  template <typename Value>
  Value Take(const char* name, Value least, Value most) {
    if (AtEnd()) {
      Fail(fmt::format("{} is missing", name));
    }
    Value value{};
    const char* const begin = columns_.data();
    const auto [end, error] = std::from_chars(begin, begin + columns_.size(), value);
    const auto length = static_cast<size_t>(end - begin);
    const bool is_whole = length == columns_.size() || columns_[length] == ' ' ||
                          columns_[length] == '\t' || columns_[length] == '\r';
    if (error != std::errc() || !is_whole || !(value >= least && value <= most)) {
      const std::string_view column = columns_.substr(0, columns_.find_first_of(" \t\r"));
      Fail(fmt::format("{} '{}', expected a number from {} to {}", name, ShowText(column), least,
                       most));
    }
    columns_.remove_prefix(length);
    return value;
  }

  void CheckEnd(size_t expected) {
    if (!AtEnd()) {
      Fail(fmt::format("has more than {} columns", expected));
    }
  }

  int line() const { return line_; }
  size_t rest() const { return rest_.size(); }

 private:
  std::string_view rest_;     // the lines after this one
  std::string_view columns_;  // the columns of this line that were not taken yet
  const std::filesystem::path& path_;
  int line_ = 0;
};

struct Shape {
  int branching = 0;
  int levels = 0;
};

Shape ReadShape(LineReader& lines) {
  lines.Next();
  Shape shape;
  shape.branching = lines.Take("branching k", 2, Vocabulary::kMostBranching);
  shape.levels = lines.Take("levels L", 1, Vocabulary::kMostLevels);
  const int scoring = lines.Take("scoring", 0, 1000);
  const int weighting = lines.Take("weighting", 0, 1000);
  lines.CheckEnd(4);
  if (scoring != 0) {
    lines.Fail(fmt::format("scoring {}, expected 0 (L1 norm)", scoring));
  }
  if (weighting != 0) {
    lines.Fail(fmt::format("weighting {}, expected 0 (tf-idf)", weighting));
  }
  return shape;
}

// Collects the nodes and checks each of them against the earlier ones.
class TreeReader {
 public:
  explicit TreeReader(const Shape& shape) : shape_(shape), known_(1) {}

  void ReadNode(LineReader& lines) {
    if (lines.AtEnd()) {
      lines.Fail(fmt::format("is empty, expected {} columns", kNodeColumns));
    }
    const auto number = static_cast<uint32_t>(known_.size());
    TreeNode& node = nodes_.emplace_back();
    node.parent = lines.Take<uint32_t>("parent", 0, std::numeric_limits<int32_t>::max());
    if (node.parent >= number) {
      lines.Fail(
          fmt::format("parent {} is not an earlier node; this is node {}", node.parent, number));
    }
    const bool is_leaf = lines.Take("is_leaf", 0, 1) == 1;
    for (size_t i = 0; i < kDescriptorBytes; ++i) {
      const uint64_t byte = lines.Take<uint32_t>("byte of the descriptor", 0, 255);
      node.descriptor[i / 8] |= byte << (i % 8 * 8);
    }
    node.weight =
        static_cast<float>(lines.Take("weight", 0.0, static_cast<double>(kMostWordWeight)));
    lines.CheckEnd(kNodeColumns);
    Known& parent = known_[node.parent];
    if (parent.is_leaf) {
      lines.Fail(fmt::format("the parent, node {}, is a leaf", node.parent));
    }
    if (++parent.children > shape_.branching) {
      lines.Fail(fmt::format("node {} has more than {} children", node.parent, shape_.branching));
    }
    const int level = parent.level + 1;
    if (level > shape_.levels) {
      lines.Fail(
          fmt::format("node {} is on level {}, expected at most {}", number, level, shape_.levels));
    }
    known_.push_back({.children = 0, .level = static_cast<int8_t>(level), .is_leaf = is_leaf});
  }

  Vocabulary Finish(const std::filesystem::path& path) const {
    if (nodes_.empty()) {
      throw InputError(path.string() + ": the vocabulary has no words");
    }
    for (size_t i = 1; i < known_.size(); ++i) {
      if (!known_[i].is_leaf && known_[i].children == 0) {
        throw InputError(fmt::format("{}:{}: node {} is not a leaf, but has no children",
                                     path.string(), i + 1, i));
      }
    }
    return BuildVocabulary(shape_.branching, shape_.levels, nodes_);
  }

 private:
  struct Known {
    int16_t children = 0;
    int8_t level = 0;
    bool is_leaf = false;
  };

  Shape shape_;
  std::vector<Known> known_;  // one per node, the root first
  std::vector<TreeNode> nodes_;
};

void AppendNode(const Vocabulary& vocabulary, uint32_t parent, uint32_t node, std::string& text) {
  const auto first_child = vocabulary.first_child();
  const bool is_leaf = first_child[node] == first_child[node + 1];
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{} {}", parent, is_leaf ? 1 : 0);
  const Descriptor& descriptor = vocabulary.descriptors()[node];
  for (size_t i = 0; i < kDescriptorBytes; ++i) {
    fmt::format_to(out, " {}", descriptor[i / 8] >> (i % 8 * 8) & 255);
  }
  fmt::format_to(out, " {}\n",
                 is_leaf ? vocabulary.weights()[vocabulary.first_word()[node]] : 0.0f);
}

}  // namespace

Vocabulary ParseVocabularyText(std::string_view text, const std::filesystem::path& path,
                               const ProgressCallback& on_progress) {
  constexpr size_t kMegabyte = 1'000'000;
  constexpr int kLinesPerStep = 50'000;
  LineReader lines(text, path);
  TreeReader tree(ReadShape(lines));
  while (lines.Next()) {
    tree.ReadNode(lines);
    if (on_progress && lines.line() % kLinesPerStep == 0) {
      on_progress(static_cast<int>((text.size() - lines.rest()) / kMegabyte),
                  static_cast<int>(text.size() / kMegabyte));
    }
  }
  return tree.Finish(path);
}

std::string FormatVocabularyText(const Vocabulary& vocabulary) {
  std::string text = fmt::format("{} {} 0 0\n", vocabulary.branching(), vocabulary.levels());
  const auto first_child = vocabulary.first_child();
  for (uint32_t parent = 0; parent < vocabulary.node_count(); ++parent) {
    for (uint32_t node = first_child[parent]; node < first_child[parent + 1]; ++node) {
      AppendNode(vocabulary, parent, node, text);
    }
  }
  return text;
}

}  // namespace hullslam
