// `--help` as a manual: what CLI11 prints of a subcommand, and what is told of it beside its options.
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <string_view>

namespace ensemble::cli {

/// What a subcommand does, and the files that it reads and writes.
struct Manual {
  std::string_view name, text, files;
};

/// The manual of a subcommand; empty texts where there is none.
Manual manualOf(std::string_view name);

/// Each option as a paragraph under its name, 80 columns wide, without CLI11's notes on types: meaning,
/// default and range stand in the option's own text.
class ManualFormatter : public CLI::Formatter {
 public:
  std::string make_description(const CLI::App* app) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
};

/// What follows the options: files, exit codes, the example.
std::string manualFooter(std::string_view name, const std::string& example);

}  // namespace ensemble::cli
