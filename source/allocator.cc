// How jemalloc, which programs are linked with where it is there, keeps memory: what has
// been freed stays with the process, in pages of 2 MB where the system has them. A change
// of the grid frees all vectors and makes others of about the same size; glibc's malloc
// seldom finds a place for them in what has been freed, and pages that are new to the
// process take as long as several steps.

extern "C" {
extern const char *malloc_conf;
const char *malloc_conf =
  "dirty_decay_ms:-1,muzzy_decay_ms:-1,thp:always,narenas:1,oversize_threshold:0";
}
