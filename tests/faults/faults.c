/* Makes one call of the C library fail, for tests/cli/faults_test.py: preloaded, with GUMSHOE_FAULT=CALL:N in the
 * environment, the N-th CALL of the process fails as on a full or broken disk, or without memory. CALL:N+ lets all from
 * there on fail, CALL:N! kills the process there. With GUMSHOE_FAULT_COUNTS=FILE the numbers of calls are written there at the end. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/types.h>
#include <unistd.h>

enum { OPEN, READ, PREAD, WRITE, PWRITE, FWRITE, FSYNC, FDATASYNC, RENAME, FTRUNCATE, FALLOCATE, MMAP, MALLOC, CALLS };
static const char* const names[CALLS] = {"open",  "read",      "pread",  "write",     "pwrite",    "fwrite", "fsync",
                                         "fdatasync", "rename", "ftruncate", "fallocate", "mmap",   "malloc"};
static const int errors[CALLS] = {EMFILE, EIO, EIO, ENOSPC, ENOSPC, ENOSPC, EIO,
                                  EIO,    EIO, EIO, ENOSPC, ENOMEM, ENOMEM};
static const size_t large = 16384; /* smaller allocations do not count: there are too many, and they rarely fail alone */

static atomic_ulong counts[CALLS];
static int chosen = -1, onwards, deadly;
static unsigned long number;

__attribute__((constructor)) static void choose(void) {
  const char* wish = getenv("GUMSHOE_FAULT");
  const char* colon = wish ? strchr(wish, ':') : NULL;
  if (!colon) return;
  for (int k = 0; k < CALLS; ++k)
    if (strlen(names[k]) == (size_t)(colon - wish) && strncmp(names[k], wish, (size_t)(colon - wish)) == 0) chosen = k;
  char* end;
  number = strtoul(colon + 1, &end, 10);
  onwards = *end == '+';
  deadly = *end == '!';
}

__attribute__((destructor)) static void report(void) {
  const char* path = getenv("GUMSHOE_FAULT_COUNTS");
  const int file = path ? (int)syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666) : -1;
  if (file < 0) return;
  char text[512];
  int length = 0;
  for (int k = 0; k < CALLS; ++k)
    length += snprintf(text + length, sizeof text - (size_t)length, "%s %lu\n", names[k], atomic_load(&counts[k]));
  syscall(SYS_write, file, text, (size_t)length);
  close(file);
}

static int fails(int call) {
  const unsigned long n = atomic_fetch_add(&counts[call], 1) + 1;
  if (call != chosen || !(n == number || (onwards && n > number))) return 0;
  if (deadly && call != PWRITE) raise(SIGKILL);
  errno = errors[call];
  return 1;
}

static int opened(const char* path, int flags, mode_t mode) {
  return fails(OPEN) ? -1 : (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
}
int open(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return opened(path, flags, mode);
}
int open64(const char* path, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  return opened(path, flags, mode);
}
ssize_t read(int file, void* data, size_t size) {
  return fails(READ) ? -1 : syscall(SYS_read, file, data, size);
}
ssize_t pread(int file, void* data, size_t size, off_t at) {
  return fails(PREAD) ? -1 : syscall(SYS_pread64, file, data, size, at);
}
ssize_t pread64(int file, void* data, size_t size, off64_t at) {
  return fails(PREAD) ? -1 : syscall(SYS_pread64, file, data, size, at);
}

/* What goes to standard error says what is wrong: it is left alone. */
ssize_t write(int file, const void* data, size_t size) {
  if (file > 2 && fails(WRITE)) return -1;
  return syscall(SYS_write, file, data, size);
}
/* Half of the data arrive before the failure. */
static ssize_t written_at(int file, const void* data, size_t size, off_t at) {
  if (!fails(PWRITE)) return syscall(SYS_pwrite64, file, data, size, at);
  syscall(SYS_pwrite64, file, data, size / 2, at);
  if (deadly) raise(SIGKILL);
  errno = errors[PWRITE];
  return -1;
}
ssize_t pwrite(int file, const void* data, size_t size, off_t at) { return written_at(file, data, size, at); }
ssize_t pwrite64(int file, const void* data, size_t size, off64_t at) { return written_at(file, data, size, at); }
size_t fwrite(const void* data, size_t size, size_t count, FILE* file) {
  static size_t (*real)(const void*, size_t, size_t, FILE*);
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "fwrite");
  return file != stdout && file != stderr && fails(FWRITE) ? 0 : real(data, size, count, file);
}
int fsync(int file) { return fails(FSYNC) ? -1 : (int)syscall(SYS_fsync, file); }
int fdatasync(int file) { return fails(FDATASYNC) ? -1 : (int)syscall(SYS_fdatasync, file); }
int rename(const char* from, const char* to) {
  return fails(RENAME) ? -1 : (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}
int ftruncate(int file, off_t size) { return fails(FTRUNCATE) ? -1 : (int)syscall(SYS_ftruncate, file, size); }
int ftruncate64(int file, off64_t size) { return fails(FTRUNCATE) ? -1 : (int)syscall(SYS_ftruncate, file, size); }
int fallocate(int file, int mode, off_t at, off_t size) {
  return fails(FALLOCATE) ? -1 : (int)syscall(SYS_fallocate, file, mode, at, size);
}
int fallocate64(int file, int mode, off64_t at, off64_t size) {
  return fails(FALLOCATE) ? -1 : (int)syscall(SYS_fallocate, file, mode, at, size);
}
void* mmap(void* place, size_t size, int protection, int flags, int file, off_t at) {
  return fails(MMAP) ? MAP_FAILED : (void*)syscall(SYS_mmap, place, size, protection, flags, file, at);
}
void* mmap64(void* place, size_t size, int protection, int flags, int file, off64_t at) {
  return fails(MMAP) ? MAP_FAILED : (void*)syscall(SYS_mmap, place, size, protection, flags, file, at);
}

/* The allocator of the GNU C library under its other names. */
extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);
static int no_memory(size_t size) { return size >= large && fails(MALLOC); }
void* malloc(size_t size) { return no_memory(size) ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return no_memory(count * size) ? NULL : __libc_calloc(count, size); }
void* realloc(void* old, size_t size) { return no_memory(size) ? NULL : __libc_realloc(old, size); }
void* memalign(size_t alignment, size_t size) { return no_memory(size) ? NULL : __libc_memalign(alignment, size); }
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** place, size_t alignment, size_t size) {
  *place = memalign(alignment, size);
  return *place ? 0 : ENOMEM;
}
