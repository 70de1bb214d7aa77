#include "postgresql_server.h"

#include <fcntl.h>
#include <grp.h>
#include <pwd.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <soci/postgresql/soci-postgresql.h>
#include <soci/soci.h>
#include <chrono>
#include <filesystem>
#include <stdexcept>
#include <thread>
#include <vector>

namespace object_modelling::keyframes
{
namespace
{
namespace fs = std::filesystem;

/// Newest installed version; empty if there is none.
std::string findPrograms()
{
  std::string best;
  int best_version = 0;
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator("/usr/lib/postgresql", ignored))
  {
    const int version = std::atoi(entry.path().filename().c_str());
    if (version > best_version && fs::exists(entry.path() / "bin/postgres") && fs::exists(entry.path() / "bin/initdb"))
    {
      best_version = version;
      best = (entry.path() / "bin").string();
    }
  }
  return best;
}

const passwd* unprivilegedUser()
{
  const passwd* user = getpwnam("postgres");
  return user != nullptr ? user : getpwnam("nobody");
}

/// Starts a program in its own process, as an unprivileged user if we are root, silent, and ending with us.
pid_t launch(const std::vector<std::string>& command, const std::string& folder)
{
  const passwd* user = geteuid() == 0 ? unprivilegedUser() : nullptr;
  const std::string log = folder + "/log";
  std::vector<char*> arguments;
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  const pid_t child = fork();
  if (child != 0)
    return child;
  if (user != nullptr && (setgroups(0, nullptr) != 0 || setgid(user->pw_gid) != 0 || setuid(user->pw_uid) != 0))
    _exit(126);
  prctl(PR_SET_PDEATHSIG, SIGQUIT);
  const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  if (chdir(folder.c_str()) != 0)
    _exit(126);
  execv(arguments[0], arguments.data());
  _exit(127);
}
}  // namespace

PostgresqlServer* PostgresqlServer::shared()
{
  static const std::string programs = findPrograms();
  static const std::unique_ptr<PostgresqlServer> server(programs.empty() ? nullptr : new PostgresqlServer(programs));
  return server.get();
}

PostgresqlServer::PostgresqlServer(const std::string& programs) : programs_(programs)
{
  const pid_t child = launch({ programs_ + "/initdb", "-D", folder_.path("data"), "-U", "modelling", "-A", "trust",
                               "-E", "UTF8", "--locale=C", "--no-sync" },
                             folder_.path());
  int result = 0;
  if (child < 0 || waitpid(child, &result, 0) != child || result != 0)
    throw std::runtime_error("initdb failed; see " + folder_.path("log"));
  start();
}

PostgresqlServer::~PostgresqlServer()
{
  stop();
}

void PostgresqlServer::start()
{
  server_ = launch({ programs_ + "/postgres", "-D", folder_.path("data"), "-k", folder_.path(), "-c",
                     "listen_addresses=", "-c", "fsync=off" },
                   folder_.path());
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (true)
  {
    try
    {
      soci::session sql(soci::postgresql, connection("postgres"));
      return;
    }
    catch (const soci::soci_error& error)
    {
      if (std::chrono::steady_clock::now() > give_up)
        throw std::runtime_error("PostgreSQL does not start: " + error.get_error_message());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

void PostgresqlServer::stop()
{
  if (server_ <= 0)
    return;
  kill(server_, SIGQUIT);
  waitpid(server_, nullptr, 0);
  server_ = -1;
}

std::string PostgresqlServer::createDatabase()
{
  const std::string name = "store_" + std::to_string(databases_++);
  soci::session sql(soci::postgresql, connection("postgres"));
  sql << "CREATE DATABASE " << name;
  return "postgresql://" + connection(name);
}

std::string PostgresqlServer::connection(const std::string& database) const
{
  return "host=" + folder_.path() + " user=modelling dbname=" + database;
}

}  // namespace object_modelling::keyframes
