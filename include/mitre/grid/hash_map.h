#ifndef mitre_grid_hash_map_h
#define mitre_grid_hash_map_h

#include <cstdint>
#include <utility>
#include <vector>

namespace mitre::grid
{
  /**
   * Values by key, for tables that are filled and emptied again thousands of times while
   * rows of interpolation weights are built: clear() costs what was inserted, and nothing
   * is allocated once the table has its size. (With std::unordered_map a change of the
   * grid took a third longer.)
   */
  template <typename Value>
  class HashMap
  {
  public:
    HashMap()
      : slots(1024, Slot{empty, Value()})
    {
    }

    /// The value that belongs to @p key, and whether the key is new; the value is then
    /// to be set. The reference is valid until the next call.
    std::pair<Value &, bool> insert(const std::uint64_t key)
    {
      std::size_t at = find(key);
      if (slots[at].key == key)
        return {slots[at].value, false};
      if (2 * used.size() >= slots.size())
        {
          grow();
          at = find(key);
        }
      slots[at].key = key;
      used.push_back(at);
      return {slots[at].value, true};
    }

    void clear()
    {
      for (const std::size_t at : used)
        slots[at].key = empty;
      used.clear();
    }

  private:
    static constexpr std::uint64_t empty = ~std::uint64_t(0);

    struct Slot
    {
      std::uint64_t key;
      Value value;
    };

    std::size_t find(const std::uint64_t key) const
    {
      const std::size_t mask = slots.size() - 1;
      std::size_t at         = (key * 0x9E3779B97F4A7C15u) >> 32 & mask;
      while (slots[at].key != key && slots[at].key != empty)
        at = (at + 1) & mask;
      return at;
    }

    void grow()
    {
      const std::vector<Slot> old           = std::move(slots);
      const std::vector<std::size_t> filled = std::move(used);
      slots.assign(2 * old.size(), Slot{empty, Value()});
      used.clear();
      for (const std::size_t i : filled)
        {
          used.push_back(find(old[i].key));
          slots[used.back()] = old[i];
        }
    }

    std::vector<Slot> slots;
    std::vector<std::size_t> used;
  };
} // namespace mitre::grid

#endif
