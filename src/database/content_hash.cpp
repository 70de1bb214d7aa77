#include "content_hash.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include <openssl/evp.h>

#include "object_modelling/base/atomic_file.h"
#include "object_modelling/base/status.h"

namespace object_modelling::database
{
namespace
{
namespace fs = std::filesystem;
using base::Error;
using base::StatusCode;

constexpr char SEAL[] = "report.sha256";
constexpr std::array<const char*, 2> REPORT_FILES{ "quality.yaml", "report.html" };

class Sha256
{
public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free)
  {
    check(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
  }
  void add(const char* data, std::size_t size) { check(EVP_DigestUpdate(context_.get(), data, size) == 1); }
  std::string finish()
  {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    check(EVP_DigestFinal_ex(context_.get(), digest.data(), &size) == 1);
    static const char HEX_DIGITS[] = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < size; ++i)
    {
      text.push_back(HEX_DIGITS[digest[i] >> 4]);
      text.push_back(HEX_DIGITS[digest[i] & 0xf]);
    }
    return text;
  }

private:
  static void check(bool done)
  {
    if (!done)
      throw Error(StatusCode::INTERNAL, "OpenSSL has no SHA-256");
  }
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};
}  // namespace

std::string hashOfText(const std::string& text)
{
  Sha256 hash;
  hash.add(text.data(), text.size());
  return hash.finish();
}

std::string hashOfFile(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw Error(StatusCode::NOT_FOUND, "cannot open " + path);
  Sha256 hash;
  std::array<char, 1 << 16> buffer{};
  while (file)
  {
    file.read(buffer.data(), buffer.size());
    hash.add(buffer.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad())
    throw Error(StatusCode::STORAGE, "cannot read " + path);
  return hash.finish();
}

std::map<std::string, std::string> hashesOfFolder(const std::string& folder)
{
  std::map<std::string, std::string> hashes;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
  {
    const fs::path relative = entry.path().lexically_relative(folder);
    const bool of_report =
        relative == SEAL || std::find(REPORT_FILES.begin(), REPORT_FILES.end(), relative) != REPORT_FILES.end();
    if (entry.is_regular_file() && relative != "object.yaml" && *relative.begin() != "recognition" && !of_report)
      hashes[relative.generic_string()] = hashOfFile(entry.path().string());
  }
  return hashes;
}

void sealReport(const std::string& folder)
{
  std::string lines;
  for (const char* file : REPORT_FILES)
    if (fs::is_regular_file(folder + "/" + file))
      lines += hashOfFile(folder + "/" + file) + "  " + file + "\n";
  if (!lines.empty())
    base::writeTextFile(folder + "/" + SEAL, lines);
}

std::vector<std::string> checkReport(const std::string& folder)
{
  std::map<std::string, std::string> listed;
  const std::string seal = folder + "/" + SEAL;
  if (fs::is_regular_file(seal))
  {
    std::istringstream lines(base::readTextFile(seal));
    std::string hash, file;
    while (lines >> hash >> file)
      listed[file] = hash;
  }
  std::vector<std::string> problems;
  for (const char* file : REPORT_FILES)
  {
    const std::string path = folder + "/" + file;
    const auto found = listed.find(file);
    const bool exists = fs::is_regular_file(path);
    if (exists && found == listed.end())
      problems.push_back(path + " is not listed in " + SEAL);
    else if (!exists && found != listed.end())
      problems.push_back(path + " is missing");
    else if (exists && hashOfFile(path) != found->second)
      problems.push_back(path + " has been changed: its SHA-256 is not the one in " + SEAL);
  }
  return problems;
}

}  // namespace object_modelling::database
