// Files that are there whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ensemble {

/// Writes aside, fsyncs, renames over `file`, fsyncs the folder. After any error, kill or full disk
/// a reader sees the old file or the new one. A symbolic link stays, its target is replaced; a
/// device or pipe is written to as it is. Leftovers of killed writers are named
/// `.NAME.PID.tmp`. @throws SystemError with the system's reason.
void writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes);
void writeFileAtomically(const std::filesystem::path& file, std::string_view text);

/// Says why a file could not be written, with what mends it. @param error errno @throws SystemError
[[noreturn]] void failWriting(const std::filesystem::path& file, int error);

/// A file that another library writes bit by bit: it writes to `aside()`, in the same folder; `commit`
/// makes that last and renames it over `file` as writeFileAtomically does. Without it, what was written
/// aside is removed.
class FileAside {
 public:
  /// @throws SystemError if `file` can't be replaced, or nothing can be written beside it
  explicit FileAside(const std::filesystem::path& file);
  ~FileAside();
  FileAside(const FileAside&) = delete;
  FileAside& operator=(const FileAside&) = delete;

  const std::filesystem::path& aside() const { return aside_; }
  /// @pre whoever wrote it has closed it @throws SystemError with the system's reason
  void commit();

 private:
  std::filesystem::path file_, target_, aside_;  ///< target: the file, or where its link leads
};

/// A whole file's bytes. @throws SystemError (exit 1) if it can't be read, InputError (exit 3) if
/// it does not exist, is not a regular file, or has more than `max_bytes`.
std::vector<std::byte> readFile(const std::filesystem::path& file, std::uint64_t max_bytes = 1ull << 32);

/// Holds an exclusive lock on `folder`/.lock, from construction to destruction, so that there is
/// one writer at a time; the kernel drops it when a process dies. Waits up to `wait_seconds`.
/// @throws SystemError when another process keeps it.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder, double wait_seconds = 30.0);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace ensemble
