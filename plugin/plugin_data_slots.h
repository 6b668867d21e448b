#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

namespace continuum {

/// Objects that belong to entries of mjData.plugin_data. An entry holds the number of a slot, no
/// pointer: pickle.loads of Python writes the entries of one mjData, maybe of another process, over
/// those of a new one. A slot knows the address of the entry that owns it, so that such a number is
/// noticed and the entry gets back its own. All members may be called from any thread.
template <class T>
class PluginDataSlots {
 public:
  PluginDataSlots() = default;
  PluginDataSlots(const PluginDataSlots&) = delete;
  ~PluginDataSlots() {
    for (std::atomic<Slot*>& block : blocks_) delete[] block.load();
  }

  /// The object of an entry; null: it has none.
  T* Find(std::uintptr_t& entry) {
    if (const Slot* slot = At(entry); slot && slot->owner.load(std::memory_order_relaxed) == &entry)
      return slot->object.get();
    return Restore(entry);
  }

  /// Gives the entry an object, in place of the one it may have had.
  void Put(std::uintptr_t& entry, std::unique_ptr<T> object) {
    Erase(entry);
    const std::lock_guard lock(mutex_);
    const std::uintptr_t number = FreeSlot();
    own_.emplace(&entry, number);
    Slot& slot = *At(number);
    slot.object = std::move(object);
    slot.owner.store(&entry, std::memory_order_relaxed);
    entry = number;
  }

  /// Destroys the object of an entry, whatever number is written there.
  void Erase(std::uintptr_t& entry) {
    std::unique_ptr<T> object;  // goes after the lock
    const std::lock_guard lock(mutex_);
    entry = 0;
    const auto own = own_.find(&entry);
    if (own == own_.end()) return;
    Slot& slot = *At(own->second);
    slot.owner.store(nullptr, std::memory_order_relaxed);
    object = std::move(slot.object);
    free_.push_back(own->second);
    own_.erase(own);
  }

 private:
  struct Slot {
    std::atomic<const std::uintptr_t*> owner = nullptr;
    std::unique_ptr<T> object;
  };

  // Block b holds the slots of the numbers from 2^b to 2^(b+1) - 1. Blocks stay where they are.
  Slot* At(std::uintptr_t number) const {
    const auto b = static_cast<std::size_t>(std::bit_width(number)) - 1;  // wraps round for 0
    Slot* const block = b < kBlocks ? blocks_[b].load(std::memory_order_acquire) : nullptr;
    return block ? block + (number - (std::uintptr_t{1} << b)) : nullptr;
  }

  T* Restore(std::uintptr_t& entry) {
    const std::lock_guard lock(mutex_);
    const auto own = own_.find(&entry);
    if (own == own_.end()) return nullptr;
    entry = own->second;
    return At(entry)->object.get();
  }

  std::uintptr_t FreeSlot() {
    if (free_.empty()) {
      if (size_ == kBlocks) throw std::length_error("more plugin instances than memory can hold");
      const std::uintptr_t first = std::uintptr_t{1} << size_;
      blocks_[size_++].store(new Slot[first], std::memory_order_release);
      for (std::uintptr_t number = 2 * first; number-- > first;) free_.push_back(number);
    }
    const std::uintptr_t number = free_.back();
    free_.pop_back();
    return number;
  }

  static constexpr std::size_t kBlocks = 40;
  std::array<std::atomic<Slot*>, kBlocks> blocks_{};
  std::size_t size_ = 0;  ///< blocks in use
  std::vector<std::uintptr_t> free_;
  std::unordered_map<const std::uintptr_t*, std::uintptr_t> own_;
  std::mutex mutex_;
};

}  // namespace continuum
