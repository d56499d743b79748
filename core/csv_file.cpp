#include "core/csv_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/input_error.h"

namespace ensemble {
namespace {

bool isBlank(char c) { return c == ' ' || c == '\t'; }

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string file, const CsvLimits& limits)
    : text_(text), file_(std::move(file)), limits_(limits) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
}

void CsvReader::fail(const SourceMark& mark, const std::string& what, const std::string& mend) const {
  throw InputError({file_, mark.toString(), what, mend});
}

bool CsvReader::readRecord(std::vector<CsvField>& fields) {
  skipEmptyLines();
  if (isAtEnd()) return false;
  for (fields.clear();;) {
    if (fields.size() == limits_.max_fields) {
      fail(mark(), fmt::format("the row has more than {} fields", limits_.max_fields),
           "see whether its line ends where it should");
    }
    readField(fields.emplace_back());
    if (isAtEnd() || skipLineEnd()) return true;
    ++at_;  // a comma
  }
}

bool CsvReader::skipLineEnd() {
  if (isAtEnd() || !isAtLineEnd()) return false;
  at_ += text_.substr(at_).starts_with("\r\n") ? 2 : 1;
  line_start_ = at_;
  ++line_;
  return true;
}

void CsvReader::skipBlanks() {
  while (!isAtEnd() && isBlank(text_[at_])) ++at_;
}

void CsvReader::skipEmptyLines() {
  while (true) {
    const std::size_t begin = at_;
    skipBlanks();
    if (isAtEnd() || skipLineEnd()) {
      if (isAtEnd()) return;
      continue;
    }
    at_ = begin;
    return;
  }
}

/// Leaves `at_` at the comma, the line's end or the text's end after it.
void CsvReader::readField(CsvField& field) {
  skipBlanks();
  field.line = line_;
  field.column = static_cast<std::uint32_t>(at_ - line_start_ + 1);
  if (!isAtEnd() && text_[at_] == '"') return readQuoted(field);
  for (; !isAtLineEnd() && text_[at_] != ','; ++at_) {
    if (text_[at_] == '"') {
      fail(mark(), "there is a quote inside a field that does not begin with one",
           "put the whole field in quotes, and write each quote in it twice");
    }
    append(field);
  }
  while (!field.text.empty() && isBlank(field.text.back())) field.text.pop_back();
}

void CsvReader::readQuoted(CsvField& field) {
  for (++at_;; ++at_) {
    if (isAtEnd()) fail(field.mark(), "the field's quotes are not closed", "add the closing quote");
    if (text_[at_] == '"') {
      if (!text_.substr(at_).starts_with("\"\"")) break;
      ++at_;  // a quote in the field is written twice
    }
    append(field);
    if (text_[at_] != '\n' && (text_[at_] != '\r' || text_.substr(at_).starts_with("\r\n"))) continue;
    line_start_ = at_ + 1;
    ++line_;
  }
  ++at_;
  skipBlanks();
  if (isAtLineEnd() || text_[at_] == ',') return;
  fail(mark(), "there is more after the field's closing quote",
       "put the whole field in quotes, and write each quote in it twice");
}

void CsvReader::append(CsvField& field) const {
  if (field.text.size() == limits_.max_field_bytes) {
    fail(field.mark(), fmt::format("the field is longer than {} bytes", limits_.max_field_bytes),
         "shorten it, or close its quotes");
  }
  field.text.push_back(text_[at_]);
}

void appendCsvField(std::string& record, std::string_view field) {
  const auto needs_quotes = [](char c) {
    return c == ',' || c == '"' || static_cast<unsigned char>(c) < 0x20;
  };
  const bool has_outer_blank = !field.empty() && (isBlank(field.front()) || isBlank(field.back()));
  if (!has_outer_blank && std::none_of(field.begin(), field.end(), needs_quotes)) {
    record += field;
    return;
  }
  record += '"';
  for (const char c : field) {
    if (c == '"') record += '"';
    record += c;
  }
  record += '"';
}

}  // namespace ensemble
