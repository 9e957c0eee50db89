// To be preloaded: a directory lists status files only half a minute after they came, though they open by name at once.
// So does NFS, whose clients keep a listing for so long.
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { late_s = 30 };

static int is_new(DIR* directory, const char* name) {
  const char* end = strrchr(name, '.');
  struct stat file;
  return end && strcmp(end, ".status") == 0 && fstatat(dirfd(directory), name, &file, 0) == 0 &&
         time(NULL) - file.st_ctime < late_s;
}

struct dirent* readdir(DIR* directory) {
  struct dirent* (*next)(DIR*) = (struct dirent * (*)(DIR*)) dlsym(RTLD_NEXT, "readdir");
  struct dirent* entry;
  do entry = next(directory);
  while (entry && is_new(directory, entry->d_name));
  return entry;
}
