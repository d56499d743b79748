#include "core/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/input_error.h"

namespace ensemble {
namespace {

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  /// Closes now and tells whether that went well: a full disk may show only here.
  bool closeNow() {
    const int number = number_;
    number_ = -1;
    return close(number) == 0;
  }

 private:
  int number_;
};

[[noreturn]] void failReading(const std::filesystem::path& file, int error) {
  const char* mend = error == EACCES || error == EPERM ? "make it readable"
                     : error == EIO                    ? "check the disk and run it again"
                                                       : "check the path";
  throw SystemError({file.string(), "", std::string("can't be read: ") + std::strerror(error), mend});
}

std::filesystem::path folderOf(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

std::filesystem::path asideOf(const std::filesystem::path& file) {
  return folderOf(file) / ("." + file.filename().string() + "." + std::to_string(getpid()) + ".tmp");
}

/// A rename outlasts a crash once its folder is on the disk. The file is in place either way.
void makeRenameLast(const std::filesystem::path& file) {
  const Descriptor folder(open(folderOf(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder.number() < 0 || fsync(folder.number()) == 0) return;
  const int error = errno;
  if (error == EINVAL || error == ENOTSUP) return;  // a file system that does not know it
  throw SystemError({file.string(), "",
                     std::string("is written, but may not outlast a crash: ") + std::strerror(error),
                     "check the disk and run it again"});
}

/// Writes all bytes; the error number, or 0.
int writeAll(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

void writeInPlace(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  Descriptor descriptor(open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (descriptor.number() < 0) failWriting(file, errno);
  int error = writeAll(descriptor.number(), bytes);
  if (!descriptor.closeNow() && error == 0) error = errno;
  if (error != 0) failWriting(file, error);
}

}  // namespace

void failWriting(const std::filesystem::path& file, int error) {
  const char* mend = error == ENOSPC || error == EDQUOT ? "free some space and run it again"
                     : error == EACCES || error == EROFS || error == EPERM
                         ? "choose a folder that you may write to"
                     : error == ENOENT ? "make its folder first"
                     : error == EIO    ? "check the disk and run it again"
                                       : "choose another place";
  throw SystemError({file.string(), "", std::string("can't be written: ") + std::strerror(error), mend});
}

void writeFileAtomically(const std::filesystem::path& file, std::span<const std::byte> bytes) {
  // Devices and pipes (/dev/stdout) are written to, never replaced; through a symbolic link its target is.
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && std::filesystem::is_other(status)) return writeInPlace(file, bytes);
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(file, ignored))) {
    const std::filesystem::path target = std::filesystem::weakly_canonical(file, ignored);
    if (!ignored && target != file) return writeFileAtomically(target, bytes);
  }

  const std::filesystem::path aside = asideOf(file);

  // Write aside, so that a reader never sees half a file.
  Descriptor descriptor(open(aside.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (descriptor.number() < 0) failWriting(file, errno);
  int error = writeAll(descriptor.number(), bytes);
  if (error == 0 && fsync(descriptor.number()) != 0) error = errno;
  if (!descriptor.closeNow() && error == 0) error = errno;
  if (error == 0 && std::rename(aside.c_str(), file.c_str()) != 0) error = errno;
  if (error != 0) {
    unlink(aside.c_str());
    failWriting(file, error);
  }

  makeRenameLast(file);
}

void writeFileAtomically(const std::filesystem::path& file, std::string_view text) {
  writeFileAtomically(file, std::as_bytes(std::span(text.data(), text.size())));
}

FileAside::FileAside(const std::filesystem::path& file) : file_(file), target_(file) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(file, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw SystemError(
        {file.string(), "", "is not a regular file, and can't be replaced by one", "choose another name"});
  }
  if (std::filesystem::is_symlink(std::filesystem::symlink_status(file, ignored))) {
    target_ = std::filesystem::weakly_canonical(file, ignored);
  }
  aside_ = asideOf(target_);
  const Descriptor descriptor(open(aside_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
  if (descriptor.number() < 0) failWriting(file_, errno);
}

FileAside::~FileAside() {
  if (!aside_.empty()) unlink(aside_.c_str());
}

void FileAside::commit() {
  Descriptor descriptor(open(aside_.c_str(), O_WRONLY | O_CLOEXEC));
  if (descriptor.number() < 0) failWriting(file_, errno);
  int error = fsync(descriptor.number()) != 0 ? errno : 0;
  if (!descriptor.closeNow() && error == 0) error = errno;
  if (error == 0 && std::rename(aside_.c_str(), target_.c_str()) != 0) error = errno;
  if (error != 0) failWriting(file_, error);
  aside_.clear();
  makeRenameLast(target_);
}

std::vector<std::byte> readFile(const std::filesystem::path& file, std::uint64_t max_bytes) {
  const Descriptor descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (descriptor.number() < 0) {
    const int error = errno;
    if (error == ENOENT || error == ENOTDIR) {
      throw InputError({file.string(), "", "no such file", "check the path"});
    }
    failReading(file, error);
  }
  struct stat status {};
  if (fstat(descriptor.number(), &status) != 0) failReading(file, errno);
  if (!S_ISREG(status.st_mode)) throw InputError({file.string(), "", "is not a regular file", "give a file"});
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > max_bytes) {
    throw InputError({file.string(), "",
                      "has " + std::to_string(size) + " bytes, more than the " + std::to_string(max_bytes) +
                          " that are read",
                      "split it or reduce its content"});
  }

  std::vector<std::byte> bytes(size);
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = read(descriptor.number(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) failReading(file, errno);
    if (count == 0) break;  // it shrank while being read
    done += static_cast<std::size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

FolderLock::FolderLock(const std::filesystem::path& folder, double wait_seconds) {
  const std::filesystem::path file = folder / ".lock";
  descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) failWriting(file, errno);
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::duration<double>(wait_seconds);
  while (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int error = errno;
    if (error == EWOULDBLOCK && std::chrono::steady_clock::now() < give_up) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      continue;
    }
    close(descriptor_);
    descriptor_ = -1;
    throw SystemError({folder.string(), "", "another process is writing this wardrobe",
                       "wait until it has finished, then run it again"});
  }
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace ensemble
