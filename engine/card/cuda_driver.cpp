#include "engine/card/cuda_driver.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace peclet::engine {
namespace {

// Types and numbers of the driver's binary interface (cuda.h, CUDA 12), which newer drivers keep.
using Result = int;                  // CUresult
using Device = int;                  // CUdevice
using Address = unsigned long long;  // CUdeviceptr
using Handle = void*;                // CUcontext, CUmodule, CUfunction and CUstream are pointers

constexpr Result not_ready = 600;  // CUDA_ERROR_NOT_READY

// CUdevice_attribute
constexpr int multiprocessor_count = 16, l2_cache_size = 38, capability_major = 75, capability_minor = 76,
              shared_memory_per_block_optin = 97;
// CUfunction_attribute
constexpr int most_threads_per_block = 0, shared_size_bytes = 1, local_size_bytes = 3, register_count = 4,
              dynamic_shared_size_bytes = 8;
// CUjit_option
constexpr int error_log_buffer = 5, error_log_buffer_size_bytes = 6;

// The least driver for PTX 7.5, and the least card for sm_80, for which cmake/card_programs.cmake compiles.
constexpr int least_driver = 11050, least_capability = 80;

#ifdef PECLET_STATIC
Handle open_library() { throw CardError("a static program cannot load the driver of a card"); }
Handle symbol(Handle, const char*) { return nullptr; }
#else
Handle open_library() {
  // It stays loaded: the driver has threads of its own.
  if (const Handle library = dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL)) return library;
  throw CardError(fmt::format("no driver of NVIDIA cards is installed ({})", dlerror()));
}

Handle symbol(Handle library, const char* name) {
  if (const Handle found = dlsym(library, name)) return found;
  throw CardError(fmt::format("the driver of the card is too old: it has no {}", name));
}
#endif

std::string words_of(const char* call, Result result);

// A function of the driver.
template <class... Arguments>
class Call {
 public:
  Call(Handle library, const char* name)
      : name_(name), function_(reinterpret_cast<Result (*)(Arguments...)>(symbol(library, name))) {}

  Result result(Arguments... arguments) const { return function_(arguments...); }
  void operator()(Arguments... arguments) const { check(result(arguments...)); }
  void check(Result result) const {
    if (result != 0) throw CardError(words_of(name_, result));
  }

 private:
  const char* name_;
  Result (*function_)(Arguments...);
};

// A function has the suffix that cuda.h gives its name.
struct Driver {
  Handle library = open_library();
  Call<Result, const char**> error_name{library, "cuGetErrorName"};
  Call<Result, const char**> error_string{library, "cuGetErrorString"};
  Call<unsigned> init{library, "cuInit"};
  Call<int*> version{library, "cuDriverGetVersion"};
  Call<int*> device_count{library, "cuDeviceGetCount"};
  Call<Device*, int> device{library, "cuDeviceGet"};
  Call<char*, int, Device> device_name{library, "cuDeviceGetName"};
  Call<int*, int, Device> device_attribute{library, "cuDeviceGetAttribute"};
  Call<Handle*, Device> retain_context{library, "cuDevicePrimaryCtxRetain"};
  Call<Device> release_context{library, "cuDevicePrimaryCtxRelease_v2"};
  Call<Handle> set_context{library, "cuCtxSetCurrent"};
  Call<Handle*, const void*, unsigned, int*, void**> load_module{library, "cuModuleLoadDataEx"};
  Call<Handle> unload_module{library, "cuModuleUnload"};
  Call<Handle*, Handle, const char*> function{library, "cuModuleGetFunction"};
  Call<int*, int, Handle> function_attribute{library, "cuFuncGetAttribute"};
  Call<Handle, int, int> set_function_attribute{library, "cuFuncSetAttribute"};
  Call<int*, Handle, int, std::size_t> occupancy{library, "cuOccupancyMaxActiveBlocksPerMultiprocessor"};
  Call<Address*, std::size_t> allocate{library, "cuMemAlloc_v2"};
  Call<Address> free{library, "cuMemFree_v2"};
  Call<Address, const void*, std::size_t> upload{library, "cuMemcpyHtoD_v2"};
  Call<Address, const void*, std::size_t, Handle> queue_upload{library, "cuMemcpyHtoDAsync_v2"};
  Call<void*, Address, std::size_t> download{library, "cuMemcpyDtoH_v2"};
  Call<Address, unsigned char, std::size_t> fill{library, "cuMemsetD8_v2"};
  Call<Handle*, unsigned> create_stream{library, "cuStreamCreate"};
  Call<Handle> synchronize{library, "cuStreamSynchronize"};
  Call<Handle> query{library, "cuStreamQuery"};
  Call<Handle> destroy_stream{library, "cuStreamDestroy_v2"};
  // The function; grid and block in three directions; shared memory; stream; arguments.
  Call<Handle, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, Handle, void**, void**>
      launch{library, "cuLaunchKernel"};
};

const Driver& loaded_driver() {
  static const Driver driver;
  return driver;
}

const Driver& driver() {
  static const Driver& ready = []() -> const Driver& {
    loaded_driver().init(0);
    return loaded_driver();
  }();
  return ready;
}

std::string words_of(const char* call, Result result) {
  const char* name = nullptr;
  const char* words = nullptr;
  loaded_driver().error_name.result(result, &name);
  loaded_driver().error_string.result(result, &words);
  return fmt::format("{}: {} ({})", call, words ? words : "an unknown error",
                     name ? std::string(name) : std::to_string(result));
}

int attribute(Device device, int which) {
  int value = 0;
  driver().device_attribute(&value, which, device);
  return value;
}

int capability(Device device) {
  return 10 * attribute(device, capability_major) + attribute(device, capability_minor);
}

// Throws CardError if there is no such card, or it is too old.
Device usable_device(int ordinal) {
  int version = 0, count = 0;
  driver().version(&version);
  if (version < least_driver) {
    throw CardError(fmt::format("the driver of the card is for CUDA {}.{}, and {}.{} is needed",
                                version / 1000, version % 1000 / 10, least_driver / 1000,
                                least_driver % 1000 / 10));
  }
  driver().device_count(&count);
  if (ordinal >= count)
    throw CardError(fmt::format("there are {} cards, and none has number {}", count, ordinal));
  Device device = 0;
  driver().device(&device, ordinal);
  if (const int found = capability(device); found < least_capability) {
    throw CardError(fmt::format("the card has compute capability {}.{}, and {}.{} is needed", found / 10,
                                found % 10, least_capability / 10, least_capability % 10));
  }
  return device;
}

}  // namespace

std::optional<std::string> why_no_card() {
  try {
    usable_device(0);
    return {};
  } catch (const CardError& error) {
    return error.what();
  }
}

Card::Card(int ordinal)
    : device_(usable_device(ordinal)),
      compute_capability_(capability(device_)),
      multiprocessors_(attribute(device_, multiprocessor_count)),
      shared_memory_per_block_(static_cast<std::size_t>(attribute(device_, shared_memory_per_block_optin))),
      l2_size_(static_cast<std::size_t>(attribute(device_, l2_cache_size))) {
  std::array<char, 256> name{};
  driver().device_name(name.data(), static_cast<int>(name.size()), device_);
  name_ = name.data();
  driver().retain_context(&context_, device_);
  use();
}

Card::~Card() { driver().release_context.result(device_); }

void Card::use() const { driver().set_context(context_); }

void Card::finish_copies() const { driver().synchronize(nullptr); }

CardStream::CardStream() {
  constexpr unsigned beside_copies = 1;  // CU_STREAM_NON_BLOCKING
  driver().create_stream(&stream_, beside_copies);
}

CardStream::~CardStream() { driver().destroy_stream.result(stream_); }

void CardStream::synchronize() const { driver().synchronize(stream_); }

bool CardStream::done() const {
  const Result result = driver().query.result(stream_);
  if (result == not_ready) return false;
  driver().query.check(result);
  return true;
}

CardMemory::CardMemory(std::size_t bytes) : size_(bytes) {
  Address address = 0;
  driver().allocate(&address, std::max<std::size_t>(bytes, 1));  // the driver refuses none
  address_ = address;
}

CardMemory::~CardMemory() {
  if (address_ != 0) driver().free.result(address_);
}

CardMemory::CardMemory(CardMemory&& other) noexcept
    : address_(std::exchange(other.address_, 0)), size_(std::exchange(other.size_, 0)) {}

CardMemory& CardMemory::operator=(CardMemory&& other) noexcept {
  std::swap(address_, other.address_);
  std::swap(size_, other.size_);
  return *this;
}

std::uint64_t CardMemory::place(std::size_t offset, std::size_t bytes) const {
  if (offset > size_ || bytes > size_ - offset) {
    throw CardError(
        fmt::format("{} bytes at {} are not within the {} bytes of a buffer", bytes, offset, size_));
  }
  return address_ + offset;
}

void CardMemory::copy_in(std::span<const std::byte> values, std::size_t offset) {
  driver().upload(place(offset, values.size()), values.data(), values.size());
}

void CardMemory::copy_in(std::span<const std::byte> values, std::size_t offset, const CardStream& stream) {
  driver().queue_upload(place(offset, values.size()), values.data(), values.size(), stream.handle());
}

void CardMemory::copy_out(std::span<std::byte> values, std::size_t offset) const {
  driver().download(values.data(), place(offset, values.size()), values.size());
}

void CardMemory::fill(unsigned char byte) { driver().fill(address_, byte, size_); }

CardKernel::CardKernel(void* function) : function_(function) {
  const auto value = [&](int which) {
    int found = 0;
    driver().function_attribute(&found, which, function);
    return found;
  };
  registers_ = value(register_count);
  local_bytes_ = value(local_size_bytes);
  shared_bytes_ = value(shared_size_bytes);
  threads_per_block_ = value(most_threads_per_block);
}

void CardKernel::allow_shared(std::size_t bytes) const {
  driver().set_function_attribute(function_, dynamic_shared_size_bytes, static_cast<int>(bytes));
}

int CardKernel::blocks_per_multiprocessor(int threads, std::size_t dynamic_shared_bytes) const {
  int blocks = 0;
  driver().occupancy(&blocks, function_, threads, dynamic_shared_bytes);
  return blocks;
}

void CardKernel::launch(unsigned grid, unsigned block, std::size_t dynamic_shared_bytes, void** arguments,
                        const CardStream& stream) const {
  driver().launch(function_, grid, 1, 1, block, 1, 1, static_cast<unsigned>(dynamic_shared_bytes),
                  stream.handle(), arguments, nullptr);
}

CardModule::CardModule(std::string_view ptx) {
  const std::string text(ptx);  // ends in a zero, as the driver wants it
  std::array<char, 16384> log{};
  std::array<int, 2> options{error_log_buffer, error_log_buffer_size_bytes};
  std::array<void*, 2> values{log.data(), std::bit_cast<void*>(log.size() - 1)};
  const Result result =
      driver().load_module.result(&module_, text.c_str(), options.size(), options.data(), values.data());
  if (result != 0) throw CardError(fmt::format("{}\n{}", words_of("cuModuleLoadDataEx", result), log.data()));
}

CardModule::~CardModule() { driver().unload_module.result(module_); }

CardKernel CardModule::kernel(const std::string& name) const {
  Handle function = nullptr;
  driver().function(&function, module_, name.c_str());
  return CardKernel(function);
}

}  // namespace peclet::engine
