#include "io/mat73_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "counted.hpp"
#include "io/number_cell.hpp"
#include "io/prose.hpp"

namespace zwidth::internal {
namespace {

using Kind = SkippedMatArray::Kind;

constexpr std::size_t most_objects = 20000;                      // in one file, over all elements of its struct arrays
constexpr std::size_t longest_name = 1024;                       // bytes
constexpr std::size_t most_values = (std::size_t{1} << 30) / 8;  // in one array
constexpr std::size_t best_compression = 1032;                   // of deflate: values that fewer bytes cannot hold

/// HDF5 takes one call at a time, and prints its errors unless told not to.
class Hdf5 {
 public:
  Hdf5() : lock_(mutex()) {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Hdf5() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }
  Hdf5(const Hdf5&) = delete;
  Hdf5(Hdf5&&) = delete;
  Hdf5& operator=(const Hdf5&) = delete;
  Hdf5& operator=(Hdf5&&) = delete;

 private:
  static std::mutex& mutex() {
    static std::mutex only;
    return only;
  }
  std::lock_guard<std::mutex> lock_;
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

/// Something that HDF5 has opened, and what closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;

  explicit operator bool() const { return id_ >= 0; }
  [[nodiscard]] hid_t get() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

bool has_attribute(const Handle& object, const char* name) { return H5Aexists(object.get(), name) > 0; }

/// The class that MATLAB has written; nothing where there is none that can be read.
std::optional<std::string> matlab_class(const Handle& object) {
  if (!has_attribute(object, "MATLAB_class")) return std::nullopt;
  const Handle attribute(H5Aopen(object.get(), "MATLAB_class", H5P_DEFAULT), H5Aclose);
  if (!attribute) return std::nullopt;
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  if (!type || !space || H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) != 0) {
    return std::nullopt;
  }
  const std::size_t size = H5Tget_size(type.get());
  if (size == 0 || size > longest_name || H5Sget_simple_extent_npoints(space.get()) != 1) return std::nullopt;
  std::string name(size, '\0');
  if (H5Aread(attribute.get(), type.get(), name.data()) < 0) return std::nullopt;
  name.resize(std::min(name.find('\0'), name.size()));
  return name;
}

/// Sizes in MATLAB's order, which is the reverse of the file's.
std::optional<std::vector<std::size_t>> dimensions_of(const Handle& dataset) {
  const Handle space(H5Dget_space(dataset.get()), H5Sclose);
  if (!space) return std::nullopt;
  std::array<hsize_t, H5S_MAX_RANK> sizes{};
  const int rank = H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr);
  if (rank < 0) return std::nullopt;
  std::vector<std::size_t> dimensions(sizes.begin(), sizes.begin() + rank);
  std::reverse(dimensions.begin(), dimensions.end());
  while (dimensions.size() < 2) dimensions.push_back(1);
  return dimensions;
}

Problem not_read(std::string part) {
  return {.code = ProblemCode::not_read_by_hdf5, .subjects = {{"part", std::move(part)}}};
}

Problem has_more_than(std::size_t most, std::string what) {
  return {
      .code = ProblemCode::has_too_many, .evidence = {counted("most", most)}, .subjects = {{"what", std::move(what)}}};
}

/// Why a dataset of so many values cannot be read; nothing where it can.
std::optional<Problem> why_unreadable(const Handle& dataset, const Handle& type, std::size_t count,
                                      std::uintmax_t file_size) {
  const Handle list(H5Dget_create_plist(dataset.get()), H5Pclose);
  if (!list) return not_read("layout");
  if (H5Pget_external_count(list.get()) > 0 || H5Pget_layout(list.get()) == H5D_VIRTUAL) {
    return Problem{.code = ProblemCode::lies_elsewhere};
  }
  if (count > most_values) return has_more_than(most_values, "values");
  const std::uintmax_t stored = H5Dget_storage_size(dataset.get());
  const std::uintmax_t needed = static_cast<std::uintmax_t>(count) * H5Tget_size(type.get());
  if (stored > file_size || needed / best_compression > stored) {
    return Problem{.code = ProblemCode::bytes_missing, .evidence = {counted("bytes", needed), counted("left", stored)}};
  }
  return std::nullopt;
}

/// Finds the arrays of an open file.
class Walk {
 public:
  explicit Walk(std::uintmax_t file_size) : file_size_(file_size) {}

  void visit_links(const Handle& group, const std::string& parent, int depth);

  MatContents contents;
  std::vector<Handle> datasets;  ///< one per contents.arrays

 private:
  void visit(Handle object, const std::string& name, int depth);
  void visit_dataset(Handle dataset, const std::string& name);
  void visit_struct_array(const Handle& references, const std::string& parent, const std::string& field, int depth);
  [[nodiscard]] bool may_visit(const std::string& name);

  std::uintmax_t file_size_;
  std::size_t visited_ = 0;
};

bool Walk::may_visit(const std::string& name) {
  if (visited_ == most_objects) {
    Problem why = has_more_than(most_objects, "arrays");
    why.evidence.push_back({"rest", 1.0});
    contents.skip(name, Kind::no_table, std::move(why));
  }
  return visited_++ < most_objects;
}

void Walk::visit_dataset(Handle dataset, const std::string& name) {
  const auto class_name = matlab_class(dataset);
  constexpr std::array<std::string_view, 11> numeric{"double", "single", "int8",  "uint8",  "int16",  "uint16",
                                                     "int32",  "uint32", "int64", "uint64", "logical"};
  const auto is = [&](std::string_view word) { return class_name == word; };
  if (is("char")) return contents.skip(name, Kind::other_class, wrong_kind("text"));
  if (is("cell")) return contents.skip(name, Kind::other_class, wrong_kind("a cell array"));
  if (is("function_handle")) return contents.skip(name, Kind::other_class, wrong_kind("a function handle"));
  const bool is_object =
      class_name && !is("struct") && std::find(numeric.begin(), numeric.end(), *class_name) == numeric.end();
  if (is_object || has_attribute(dataset, "MATLAB_object_decode")) {
    return contents.skip(name, Kind::object, wrong_kind("a MATLAB object"));
  }
  if (is("struct") || has_attribute(dataset, "MATLAB_empty"))
    return contents.skip(name, Kind::no_table, wrong_kind("empty"));
  const Handle type(H5Dget_type(dataset.get()), H5Tclose);
  const auto dimensions = dimensions_of(dataset);
  if (!type || !dimensions) return contents.skip(name, Kind::damaged, not_read("size"));
  const H5T_class_t stored = H5Tget_class(type.get());
  if (stored == H5T_COMPOUND) return contents.skip(name, Kind::complex, wrong_kind("complex"));
  if (stored != H5T_INTEGER && stored != H5T_FLOAT)
    return contents.skip(name, Kind::other_class, wrong_kind("not numeric"));
  const std::size_t count = mat_count(*dimensions, most_values);
  if (const auto why = why_unreadable(dataset, type, count, file_size_)) {
    return contents.skip(name, Kind::damaged, *why);
  }
  const std::size_t before = contents.arrays.size();
  contents.add(name, class_name.value_or(stored == H5T_FLOAT ? "float" : "integer"), *dimensions);
  if (contents.arrays.size() > before) datasets.push_back(std::move(dataset));
}

/// A field of a struct array is a dataset of references, one for each element.
void Walk::visit_struct_array(const Handle& references, const std::string& parent, const std::string& field,
                              int depth) {
  const std::string name = fmt::format("{}.{}", parent, field);
  const auto dimensions = dimensions_of(references);
  const std::size_t count = dimensions ? mat_count(*dimensions, most_objects) : 0;
  if (count == 0) return contents.skip(name, Kind::no_table, wrong_kind("empty"));
  if (count > most_objects) {
    return contents.skip(name, Kind::no_table, has_more_than(most_objects, "elements"));
  }
  std::vector<hobj_ref_t> elements(count);
  if (H5Dread(references.get(), H5T_STD_REF_OBJ, H5S_ALL, H5S_ALL, H5P_DEFAULT, elements.data()) < 0) {
    return contents.skip(name, Kind::damaged, not_read("references"));
  }
  for (std::size_t i = 0; i < count; ++i) {
    Handle object(H5Rdereference2(references.get(), H5P_DEFAULT, H5R_OBJECT, &elements[i]), H5Oclose);
    visit(std::move(object), mat_field_name(parent, i, count, field), depth + 1);
  }
}

void Walk::visit(Handle object, const std::string& name, int depth) {
  if (!may_visit(name)) return;
  if (!object) return contents.skip(name, Kind::damaged, {.code = ProblemCode::not_read_by_hdf5});
  if (depth > mat_deepest_nesting) {
    return contents.skip(name, Kind::damaged,
                         {.code = ProblemCode::nested_too_deep, .evidence = {{"most", mat_deepest_nesting}}});
  }
  const H5I_type_t type = H5Iget_type(object.get());
  if (type == H5I_DATASET) return visit_dataset(std::move(object), name);
  if (type != H5I_GROUP) return contents.skip(name, Kind::other_class, wrong_kind("no array"));
  if (has_attribute(object, "MATLAB_sparse")) return contents.skip(name, Kind::other_class, wrong_kind("sparse"));
  const auto class_name = matlab_class(object);
  if ((class_name && *class_name != "struct") || has_attribute(object, "MATLAB_object_decode")) {
    return contents.skip(name, Kind::object, wrong_kind("a MATLAB object"));
  }
  visit_links(object, name, depth + 1);
}

/// `parent` is the struct's name, empty for the file's variables.
void Walk::visit_links(const Handle& group, const std::string& parent, int depth) {
  H5G_info_t info{};
  if (H5Gget_info(group.get(), &info) < 0) return contents.skip(parent, Kind::damaged, not_read("fields"));
  for (hsize_t i = 0; i < info.nlinks && visited_ <= most_objects; ++i) {
    std::string link(longest_name + 1, '\0');
    const auto length =
        H5Lget_name_by_idx(group.get(), ".", H5_INDEX_NAME, H5_ITER_INC, i, link.data(), link.size(), H5P_DEFAULT);
    if (length < 0 || static_cast<std::size_t>(length) > longest_name) {
      contents.skip(parent, Kind::damaged, not_read("field names"));
      continue;
    }
    link.resize(static_cast<std::size_t>(length));
    if (parent.empty() && link.starts_with('#')) continue;  // #refs#, #subsystem#: what MATLAB keeps for itself
    const std::string field = as_utf8(link);
    const std::string name = parent.empty() ? field : mat_field_name(parent, 0, 1, field);
    H5L_info_t link_info{};
    if (H5Lget_info(group.get(), link.c_str(), &link_info, H5P_DEFAULT) < 0 || link_info.type != H5L_TYPE_HARD) {
      contents.skip(name, Kind::other_class, {.code = ProblemCode::lies_elsewhere});
      continue;
    }
    Handle object(H5Oopen(group.get(), link.c_str(), H5P_DEFAULT), H5Oclose);
    if (object && !parent.empty() && H5Iget_type(object.get()) == H5I_DATASET &&
        !has_attribute(object, "MATLAB_class")) {
      const Handle type(H5Dget_type(object.get()), H5Tclose);
      if (type && H5Tequal(type.get(), H5T_STD_REF_OBJ) > 0) {
        visit_struct_array(object, parent, field, depth);
        continue;
      }
    }
    visit(std::move(object), name, depth);
  }
}

/// An open file and its datasets, closed under the lock.
class OpenFile {
 public:
  OpenFile(Handle file, std::vector<Handle> datasets) : file_(std::move(file)), datasets_(std::move(datasets)) {}
  ~OpenFile() {
    const Hdf5 quiet;
    datasets_.clear();
    const Handle closed(std::move(file_));
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile(OpenFile&&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  OpenFile& operator=(OpenFile&&) = delete;

  /// Whether all values of an array could be read.
  [[nodiscard]] bool read(std::size_t array, std::vector<double>& values) const {
    const Hdf5 quiet;
    return H5Dread(datasets_.at(array).get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  }

 private:
  Handle file_;
  std::vector<Handle> datasets_;
};

}  // namespace

tl::expected<MatFile, InputError> open_mat73_file(const std::string& path) {
  const Hdf5 quiet;
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (error || !file) {
    return tl::unexpected(
        InputError({.file = path}, {.code = ProblemCode::damaged_file, .subjects = {{"version", "7.3"}}}));
  }
  const Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose);
  Walk walk(size);
  if (root) walk.visit_links(root, "", 0);
  const auto open = std::make_shared<OpenFile>(std::move(file), std::move(walk.datasets));
  const auto values =
      [open, path, arrays = walk.contents.arrays](std::size_t array) -> tl::expected<std::vector<double>, InputError> {
    std::vector<double> numbers(arrays.at(array).rows * arrays[array].columns);
    if (open->read(array, numbers)) return numbers;
    return tl::unexpected(InputError({.file = path, .key = shortened(arrays[array].name)}, not_read("values")));
  };
  return MatFile{std::move(walk.contents), values};
}

}  // namespace zwidth::internal
