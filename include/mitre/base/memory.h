#ifndef mitre_base_memory_h
#define mitre_base_memory_h

namespace mitre::base
{
  /**
   * Tells the C library to keep freed memory for this process.
   *
   * A change of the grid frees and allocates all vectors; were they returned to the
   * system, it would have to clear every page of them again, which took half of the time.
   * To be called once, when a program starts; the most that a process uses stays the
   * same. Does nothing where the C library is not glibc.
   */
  void keep_freed_memory();
} // namespace mitre::base

#endif
