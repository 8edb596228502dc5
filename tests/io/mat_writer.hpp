#pragma once

#include <matio.h>

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace zwidth {

/// Writes MAT files with matio, which is none of the library's own code.
class MatWriter {
 public:
  using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

  MatWriter(const std::string& path, mat_ft version)
      : file_(Mat_CreateVer(path.c_str(), nullptr, version), &Mat_Close) {
    if (!file_) throw std::runtime_error("matio cannot create " + path);
  }

  void add(Variable variable, matio_compression compression = MAT_COMPRESSION_ZLIB) {
    if (Mat_VarWrite(file_.get(), variable.get(), compression) != 0) throw std::runtime_error("matio cannot write");
  }
  void add(const std::string& name, const std::vector<double>& values) { add(column(name, values)); }

  /// An array of numbers of type T, rows x columns, column after column.
  template <class T>
  [[nodiscard]] static Variable array(const std::string& name, matio_classes matlab_class, matio_types type,
                                      std::size_t rows, std::size_t columns, std::vector<T> values, int flags = 0) {
    std::size_t dimensions[] = {rows, columns};
    return checked(Mat_VarCreate(name.c_str(), matlab_class, type, 2, dimensions, values.data(), flags));
  }
  [[nodiscard]] static Variable column(const std::string& name, const std::vector<double>& values) {
    return array(name, MAT_C_DOUBLE, MAT_T_DOUBLE, values.size(), 1, values);
  }
  [[nodiscard]] static Variable text(const std::string& name, const std::string& value) {
    return array(name, MAT_C_CHAR, MAT_T_UINT8, 1, value.size(), std::vector<char>(value.begin(), value.end()));
  }
  [[nodiscard]] static Variable complex(const std::string& name, std::vector<double> real,
                                        std::vector<double> imaginary) {
    std::size_t dimensions[] = {real.size(), 1};
    mat_complex_split_t parts{real.data(), imaginary.data()};
    return checked(Mat_VarCreate(name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dimensions, &parts, MAT_F_COMPLEX));
  }
  [[nodiscard]] static Variable cell(const std::string& name, std::vector<Variable> elements) {
    std::size_t dimensions[] = {elements.size(), 1};
    std::vector<matvar_t*> pointers;
    for (Variable& element : elements) pointers.push_back(element.release());
    return checked(Mat_VarCreate(name.c_str(), MAT_C_CELL, MAT_T_CELL, 2, dimensions, pointers.data(), 0));
  }

  /// A struct array; `elements` hold their fields in the order of `names`.
  [[nodiscard]] static Variable structure(const std::string& name, const std::vector<std::string>& names,
                                          std::vector<std::vector<Variable>> elements) {
    std::vector<const char*> fields;
    for (const std::string& field : names) fields.push_back(field.c_str());
    fields.push_back(nullptr);
    const std::size_t dimensions[] = {1, elements.size()};
    Variable made = checked(Mat_VarCreateStruct2(name.c_str(), 2, dimensions, fields.data()));
    if (made->internal == nullptr) throw std::runtime_error("matio has made no struct");
    for (std::size_t i = 0; i < elements.size(); ++i) {
      for (std::size_t k = 0; k < names.size(); ++k) {
        Mat_VarSetStructFieldByName(made.get(), fields[k], i, elements[i][k].release());
      }
    }
    return made;
  }

 private:
  static Variable checked(matvar_t* variable) {
    if (variable == nullptr) throw std::runtime_error("matio cannot make a variable");
    return {variable, &Mat_VarFree};
  }
  std::unique_ptr<mat_t, decltype(&Mat_Close)> file_;
};

}  // namespace zwidth
