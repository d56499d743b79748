// Makes one call of a program fail: preloaded (LD_PRELOAD) by faults_test.py, no part of the program.
//
//   FAULT=alloc|open|read|write|fsync|rename|mkdir   what fails
//   FAULT_AT=N        the N-th such call fails (1 is the first; 0: none does)
//   FAULT_LASTS=1     and so do all after it
//   FAULT_ERRNO=N     with this error number (alloc: always ENOMEM)
//   FAULT_FOLDER=DIR  only files below it count, and those named by relative paths
//   FAULT_COUNT=FILE  receives how many such calls there were
//
// Calls count from main's beginning to its end: what the runtime does before is not the program's.
// Not for sanitized builds: their runtimes allocate, and replace malloc, themselves.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

constexpr int kMaxDescriptors = 1024;
const char* g_kind = "";
const char* g_folder = "";
long g_at = 0;
bool g_lasts = false;
int g_errno = ENOSPC;
std::atomic<bool> g_armed{false};
std::atomic<long> g_count{0};
std::atomic<bool> g_is_ours[kMaxDescriptors];
int (*g_main)(int, char**, char**) = nullptr;

/// Counts a call of this kind; whether it shall fail.
bool fails(const char* kind) {
  if (!g_armed.load(std::memory_order_relaxed) || std::strcmp(kind, g_kind) != 0) return false;
  const long number = ++g_count;
  const bool failing = g_at > 0 && (number == g_at || (g_lasts && number > g_at));
  if (failing) errno = std::strcmp(kind, "alloc") == 0 ? ENOMEM : g_errno;
  return failing;
}

bool isOurs(const char* path) {
  return path[0] != '/' || std::strncmp(path, g_folder, std::strlen(g_folder)) == 0;
}
bool isOurs(int descriptor) {
  return descriptor > 2 && descriptor < kMaxDescriptors && g_is_ours[descriptor];
}

int openFile(int folder, const char* path, int flags, unsigned mode) {
  const bool ours = isOurs(path);
  if (ours && fails("open")) return -1;
  const long descriptor = syscall(SYS_openat, folder, path, flags, mode);
  if (descriptor >= 0 && descriptor < kMaxDescriptors) g_is_ours[descriptor] = ours;
  return static_cast<int>(descriptor);
}

int countedMain(int argc, char** argv, char** environment) {
  const auto text = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
  };
  g_kind = text("FAULT");
  g_folder = text("FAULT_FOLDER");
  g_at = std::atol(text("FAULT_AT"));
  g_lasts = *text("FAULT_LASTS") != '\0';
  if (*text("FAULT_ERRNO") != '\0') g_errno = std::atoi(text("FAULT_ERRNO"));
  const char* count_file = text("FAULT_COUNT");
  g_armed = true;
  const int code = g_main(argc, argv, environment);
  g_armed = false;
  if (*count_file != '\0') {
    char line[32];
    const int length = std::snprintf(line, sizeof line, "%ld\n", g_count.load());
    const long file = syscall(SYS_openat, AT_FDCWD, count_file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (syscall(SYS_write, file, line, length) != length) std::abort();
    syscall(SYS_close, file);
  }
  return code;
}

unsigned modeOf(int flags, std::va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, unsigned) : 0u;
}

}  // namespace

extern "C" {

int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*fini)(),
                      void (*rtld_fini)(), void* stack_end) {
  g_main = main;
  const auto real = reinterpret_cast<decltype(&__libc_start_main)>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return real(countedMain, argc, argv, init, fini, rtld_fini, stack_end);
}

void* malloc(std::size_t size) { return fails("alloc") ? nullptr : __libc_malloc(size); }
void* calloc(std::size_t count, std::size_t size) {
  return fails("alloc") ? nullptr : __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) {
  return fails("alloc") ? nullptr : __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  return fails("alloc") ? nullptr : __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) { return memalign(alignment, size); }
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  void* memory = memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *block = memory;
  return 0;
}

int open(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const unsigned mode = modeOf(flags, arguments);
  va_end(arguments);
  return openFile(AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  std::va_list arguments;
  va_start(arguments, flags);
  const unsigned mode = modeOf(flags, arguments);
  va_end(arguments);
  return openFile(AT_FDCWD, path, flags, mode);
}
ssize_t read(int descriptor, void* bytes, std::size_t size) {
  if (isOurs(descriptor) && fails("read")) return -1;
  return syscall(SYS_read, descriptor, bytes, size);
}
ssize_t write(int descriptor, const void* bytes, std::size_t size) {
  if (isOurs(descriptor) && fails("write")) return -1;
  return syscall(SYS_write, descriptor, bytes, size);
}
int fsync(int descriptor) {
  if (isOurs(descriptor) && fails("fsync")) return -1;
  return static_cast<int>(syscall(SYS_fsync, descriptor));
}
int rename(const char* from, const char* to) noexcept {
  if (isOurs(to) && fails("rename")) return -1;
  return static_cast<int>(syscall(SYS_rename, from, to));
}
int mkdir(const char* path, mode_t mode) noexcept {
  if (isOurs(path) && fails("mkdir")) return -1;
  return static_cast<int>(syscall(SYS_mkdir, path, mode));
}
}
