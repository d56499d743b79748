// Reads as JuPedSim writes, and as PedPy and JPSreport read: header comments such as
// `#framerate: 16.00`, `# id frame x/m y/m z/m` and `#ID FR X Y Z A B ANGLE COLOR`.
#include "core/trajectory_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "core/atomic_file.h"
#include "core/input_error.h"

namespace ensemble {
namespace {

constexpr const char* kBlanks = " \t\r\v\f";
constexpr double kMaxFps = 1000.0;

/// A word of a line, and where it begins.
struct Field {
  std::string_view text;
  std::size_t column = 1;
};

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
bool isLetter(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }

std::string lowerCase(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), lower);
  return result;
}

/// The text in quotes, as much of it as a message can take.
std::string quoted(std::string_view text) {
  constexpr std::size_t kMostShown = 40;
  return text.size() <= kMostShown ? fmt::format("'{}'", text)
                                   : fmt::format("'{} ...'", text.substr(0, kMostShown));
}

std::vector<Field> splitFields(std::string_view line) {
  std::vector<Field> fields;
  for (std::size_t at = line.find_first_not_of(kBlanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(kBlanks, at), line.size());
    fields.push_back({line.substr(at, end - at), at + 1});
    at = line.find_first_not_of(kBlanks, end);
  }
  return fields;
}

/// A finite decimal number and nothing else.
std::optional<double> parseNumber(std::string_view text) {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

class TrajectoryReader {
 public:
  TrajectoryReader(const std::string& file, const TrajectoryLimits& limits) : file_(file), limits_(limits) {}

  Trajectories read(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    while (!text.empty()) {
      ++line_;
      const std::size_t end = std::min(text.find('\n'), text.size());
      if (end > limits_.max_line_bytes) {
        fail(limits_.max_line_bytes + 1,
             fmt::format("the line is longer than {} bytes", limits_.max_line_bytes),
             "write one sample a line: id frame x y z");
      }
      readLine(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    return finish();
  }

 private:
  [[noreturn]] void fail(std::size_t column, const std::string& what, const std::string& mend) const {
    throw InputError({file_, fmt::format("{}:{}", line_, column), what, mend});
  }

  void readLine(std::string_view line) {
    const std::size_t first = line.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return;
    if (line[first] != '#') return readSample(splitFields(line));
    if (sample_count_ > 0) return;  // comments tell about what follows the header only
    const std::size_t begin = std::min(line.find_first_not_of("# \t", first), line.size());
    const Field comment{line.substr(begin), begin + 1};
    readFrameRate(comment);
    readUnit(comment);
    readColumns(comment);
  }

  /// `framerate: 25.00` anywhere in a comment, `fps: 25` at its beginning.
  void readFrameRate(const Field& comment) {
    const std::string text = lowerCase(comment.text);
    std::size_t at = std::string::npos;
    for (const std::string_view key : {"framerate", "frame rate", "frame_rate"}) {
      const std::size_t found = text.find(key);
      if (found != std::string::npos) at = std::min(at, found + key.size());
    }
    if (at == std::string::npos && text.starts_with("fps")) at = 3;
    if (at == std::string::npos) return;
    const std::size_t begin = std::min(text.find_first_not_of(" \t:=", at), text.size());
    const std::size_t end = std::min(text.find_first_of(" \t\r,;", begin), text.size());
    std::string_view word = std::string_view(text).substr(begin, end - begin);
    if (word.ends_with("fps")) word.remove_suffix(3);
    const std::optional<double> fps = parseNumber(word);
    const bool is_claimed = text.substr(at, begin - at).find_first_of(":=") != std::string::npos;
    if (!fps && !is_claimed) return;  // prose
    const std::size_t column = comment.column + begin;
    if (!fps || !(*fps > 0.0 && *fps <= kMaxFps)) {
      fail(column, fmt::format("the frame rate {} is no number above 0, up to {}", quoted(word), kMaxFps),
           "write it as `# framerate: 25.00`, in frames a second");
    }
    const auto rate = static_cast<float>(*fps);
    if (result_.fps != 0.0f && result_.fps != rate) {
      fail(column, fmt::format("the frame rate {} contradicts the {} above", rate, result_.fps),
           "leave one of the two comments");
    }
    result_.fps = rate;
  }

  /// `x/cm` in the list of columns, `in cm`, `unit: cm`.
  void readUnit(const Field& comment) {
    const std::string text = lowerCase(comment.text);
    for (const std::string_view key : {"x/", "in ", "unit:", "unit: "}) {
      for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
        if (at > 0 && isLetter(text[at - 1])) continue;
        std::size_t end = at + key.size();
        while (end < text.size() && isLetter(text[end])) ++end;
        const std::string unit = text.substr(at + key.size(), end - at - key.size());
        if (unit == "cm") metres_per_unit_ = 0.01;
        if (unit == "mm") metres_per_unit_ = 0.001;
        if (unit == "m") metres_per_unit_ = 1.0;
      }
    }
  }

  /// A comment that names columns: the first four must be ours, the fifth tells whether there is a z.
  void readColumns(const Field& comment) {
    const std::vector<Field> names = splitFields(comment.text);
    if (names.size() < 4) return;
    const auto named = [&](std::size_t i) {
      const std::string name = lowerCase(names[i].text);
      return name.substr(0, name.find('/'));
    };
    const auto isId = [&](std::size_t i) {
      return named(i) == "id" || named(i) == "persid" || named(i) == "person_id";
    };
    const auto isFrame = [&](std::size_t i) { return named(i) == "frame" || named(i) == "fr"; };
    if (!(isId(0) && isFrame(1)) && !(isFrame(0) && isId(1))) return;  // prose
    if (!isId(0) || named(2) != "x" || named(3) != "y") {
      fail(comment.column, "the columns are in another order than id frame x y z",
           "write them in that order");
    }
    has_z_ = names.size() > 4 && named(4) == "z";
  }

  void readSample(const std::vector<Field>& fields) {
    if (fields.size() < 4) {
      fail(fields.back().column + fields.back().text.size(),
           fmt::format("the line has {} of the fields id frame x y z", fields.size()),
           "write at least id, frame, x and y");
    }
    const std::uint32_t id = wholeNumber(fields[0], "a person's number");
    const std::uint32_t frame = wholeNumber(fields[1], "a frame's number");
    const double x = coordinate(fields[2]), y = coordinate(fields[3]);
    const bool reads_z = has_z_ && fields.size() > 4;
    const double z = reads_z ? coordinate(fields[4]) : 0.0;
    if (fields.size() > (reads_z ? 5u : 4u) && first_extra_line_ == 0) first_extra_line_ = line_;
    addSample(personOf(id, frame, fields[0]), frame, Vec3(x, z, 0.0 - y), fields[1]);  // no -0
  }

  /// Whole numbers may be written as some tools write all numbers: 1.000e+00.
  std::uint32_t wholeNumber(const Field& field, const char* what) const {
    constexpr double kMost = 2147483647.0;
    const std::optional<double> number = parseNumber(field.text);
    if (!number || *number < 0.0 || *number > kMost || std::floor(*number) != *number) {
      fail(field.column, fmt::format("{} is not {}", quoted(field.text), what),
           "write a whole number from 0 to 2147483647");
    }
    return static_cast<std::uint32_t>(*number);
  }

  double coordinate(const Field& field) const {
    const std::optional<double> number = parseNumber(field.text);
    if (!number) {
      fail(field.column, fmt::format("{} is not a coordinate", quoted(field.text)),
           "write a decimal number such as -1.25");
    }
    const double metres = *number * metres_per_unit_;
    if (std::abs(metres) > limits_.max_metres) {
      fail(field.column,
           fmt::format("the coordinate {} is more than {} m from the origin", quoted(field.text),
                       limits_.max_metres),
           "move the origin near the people, and check the unit");
    }
    return metres;
  }

  /// The person of this number: its index in `result_.people`.
  std::size_t personOf(std::uint32_t id, std::uint32_t frame, const Field& field) {
    const auto [entry, is_new] = index_of_id_.try_emplace(id, result_.people.size());
    if (is_new) {
      if (result_.people.size() >= limits_.max_people) {
        fail(field.column, fmt::format("there are more than {} people", limits_.max_people),
             "split the file");
      }
      result_.people.push_back({id, frame, {}});
    }
    return entry->second;
  }

  void addSample(std::size_t index, std::uint32_t frame, const Vec3& position, const Field& field) {
    Trajectory& person = result_.people[index];
    if (!person.positions.empty()) {
      const auto last = static_cast<std::uint32_t>(person.first_frame + person.positions.size() - 1);
      if (frame == last) {
        fail(field.column, fmt::format("frame {} of person {} stands twice", frame, person.id),
             "leave one of the two lines");
      }
      if (frame < last) {
        fail(field.column, fmt::format("frame {} of person {} comes after frame {}", frame, person.id, last),
             "sort each person's lines by frame");
      }
      fillGap(person, frame - last - 1, position, field);
    }
    countSample(field);
    person.positions.push_back(position);
  }

  void fillGap(Trajectory& person, std::uint32_t missing, const Vec3& next, const Field& field) {
    if (missing == 0) return;
    if (missing > limits_.max_gap_frames) {
      fail(field.column,
           fmt::format("{} frames of person {} are missing before this one, more than the {} that are "
                       "interpolated",
                       missing, person.id, limits_.max_gap_frames),
           "add them, or give the person another id from here on");
    }
    const Vec3 from = person.positions.back();
    for (std::uint32_t i = 1; i <= missing; ++i) {
      countSample(field);
      const float share = static_cast<float>(i) / static_cast<float>(missing + 1);
      person.positions.push_back(from + share * (next - from));
    }
    interpolated_ += missing;
  }

  void countSample(const Field& field) {
    if (++sample_count_ > limits_.max_samples) {
      fail(field.column, fmt::format("there are more than {} samples", limits_.max_samples),
           "split the file");
    }
  }

  Trajectories finish() {
    if (result_.people.empty()) {
      throw InputError({file_, "", "there is no trajectory in this file", "write lines `id frame x y z`"});
    }
    if (first_extra_line_ > 0) {
      result_.warnings.push_back(
          fmt::format("{}:{}: columns after id frame x y z are not used", file_, first_extra_line_));
    }
    if (interpolated_ > 0) {
      result_.warnings.push_back(
          fmt::format("{}: {} missing frames were interpolated", file_, interpolated_));
    }
    std::sort(result_.people.begin(), result_.people.end(),
              [](const Trajectory& a, const Trajectory& b) { return a.id < b.id; });
    return std::move(result_);
  }

  const std::string& file_;
  const TrajectoryLimits& limits_;
  Trajectories result_;
  std::map<std::uint32_t, std::size_t> index_of_id_;  // a hash could be attacked
  std::size_t line_ = 0, first_extra_line_ = 0, sample_count_ = 0, interpolated_ = 0;
  double metres_per_unit_ = 1.0;
  bool has_z_ = true;
};

}  // namespace

Trajectories parseTrajectories(std::string_view text, const std::string& file,
                               const TrajectoryLimits& limits) {
  return TrajectoryReader(file, limits).read(text);
}

Trajectories loadTrajectories(const std::filesystem::path& file, const TrajectoryLimits& limits) {
  const std::vector<std::byte> bytes = readFile(file, limits.max_bytes);
  return parseTrajectories({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file.string(),
                           limits);
}

}  // namespace ensemble
