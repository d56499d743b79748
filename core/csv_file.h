// Comma-separated values (RFC 4180), record by record, with places for messages.
//
// Beyond the RFC: a byte order mark is skipped, a line may end in LF, CR LF or CR, lines without anything
// on them are skipped, and blanks around a field count only inside quotes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/source_mark.h"

namespace ensemble {

/// A field, without its quotes, and where it begins.
struct CsvField {
  std::string text;
  std::uint32_t line = 1, column = 1;  ///< bytes, from 1

  SourceMark mark() const { return {static_cast<int>(line), static_cast<int>(column), ""}; }
};

struct CsvLimits {
  std::size_t max_field_bytes = 4096;
  std::size_t max_fields = 64;  ///< of a record
};

class CsvReader {
 public:
  /// `text` must outlive the reader; `file` stands for it in messages.
  CsvReader(std::string_view text, std::string file, const CsvLimits& limits = {});

  /// The next record's fields, one at least. False at the end of the text.
  /// @throws InputError FILE: LINE:COLUMN: ... for quotes that don't fit, and beyond the limits
  bool readRecord(std::vector<CsvField>& fields);

  [[noreturn]] void fail(const SourceMark& mark, const std::string& what, const std::string& mend) const;

 private:
  bool isAtEnd() const { return at_ == text_.size(); }
  bool isAtLineEnd() const { return isAtEnd() || text_[at_] == '\n' || text_[at_] == '\r'; }
  bool skipLineEnd();
  void skipBlanks();
  void skipEmptyLines();
  void readField(CsvField& field);
  void readQuoted(CsvField& field);
  void append(CsvField& field) const;
  SourceMark mark() const { return {static_cast<int>(line_), static_cast<int>(at_ - line_start_ + 1), ""}; }

  std::string_view text_;
  std::string file_;
  CsvLimits limits_;
  std::size_t at_ = 0, line_start_ = 0;
  std::uint32_t line_ = 1;
};

/// Appends a field to a record that is being written, in quotes where it needs them.
void appendCsvField(std::string& record, std::string_view field);

}  // namespace ensemble
