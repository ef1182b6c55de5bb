#include <gtest/gtest.h>
#include <sched.h>

#include <cstdlib>

#include "contract/durable_file.h"
#include "runner/engines/engine_process.h"
#include "runner/engines/worker_process.h"
#include "tests/runner/runner_fixture.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// taskset and Slurm's cpusets set this mask; the machine may have more cores.
TEST(UsableCores, AreThoseOfTheAffinityMask) {
  cpu_set_t before;
  ASSERT_EQ(sched_getaffinity(0, sizeof(before), &before), 0);
  EXPECT_LE(usable_cores(), CPU_COUNT(&before));
  cpu_set_t one;
  CPU_ZERO(&one);
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &before) && CPU_COUNT(&one) == 0) CPU_SET(core, &one);
  }
  ASSERT_EQ(sched_setaffinity(0, sizeof(one), &one), 0);
  EXPECT_EQ(usable_cores(), 1);
  ASSERT_EQ(sched_setaffinity(0, sizeof(before), &before), 0);
}

// Manuals: sbatch(1), PBS Professional's reference guide, LSF's list of variables, qsub(1).
TEST(UsableCores, AreThoseOfAJob) {
  const std::pair<const char*, const char*> systems[] = {{"SLURM_JOB_ID", "SLURM_CPUS_ON_NODE"},
                                                         {"PBS_JOBID", "NCPUS"},
                                                         {"LSB_JOBID", "LSB_DJOB_NUMPROC"},
                                                         {"SGE_TASK_ID", "NSLOTS"}};
  for (const auto& [job, cores] : systems) {  // the tests themselves may run in a job
    ::unsetenv(job);
    ::unsetenv(cores);
  }
  EXPECT_EQ(cores_of_job(), std::nullopt);
  for (const auto& [job, cores] : systems) {
    ASSERT_EQ(::setenv(cores, "1", 1), 0);
    EXPECT_EQ(cores_of_job(), std::nullopt) << cores << " outside of a job";
    ASSERT_EQ(::setenv(job, "7", 1), 0);
    EXPECT_EQ(usable_cores(), 1);
    ASSERT_EQ(::setenv(cores, "100000", 1), 0);
    EXPECT_EQ(cores_of_job(), 100000);
    EXPECT_LT(usable_cores(), 100000) << "a job has no more than the machine";
    for (const char* nonsense : {"", "0", "-3", "4(x2)"}) {
      ASSERT_EQ(::setenv(cores, nonsense, 1), 0);
      EXPECT_EQ(cores_of_job(), std::nullopt) << nonsense;
    }
    ::unsetenv(job);
    ::unsetenv(cores);
  }
}

class CoreQuota : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) {
    fs::create_directories((folder_.path() / file).parent_path());
    write_durably(folder_.path() / file, text);
  }
  std::optional<double> quota(const std::string& groups) { return core_quota(folder_.path(), groups); }

  TemporaryFolder folder_;
};

TEST_F(CoreQuota, IsTheLeastOfAGroupAndThoseAboveIt) {
  EXPECT_EQ(quota("0::/slurm/job_7\n"), std::nullopt);
  write("slurm/job_7/cpu.max", "400000 100000\n");
  EXPECT_EQ(quota("0::/slurm/job_7\n"), 4);
  write("slurm/cpu.max", "max 100000\n");
  EXPECT_EQ(quota("0::/slurm/job_7\n"), 4);
  write("cpu.max", "150000 100000\n");
  EXPECT_EQ(quota("0::/slurm/job_7\n"), 1.5);
  EXPECT_EQ(quota("0::/\n"), 1.5);
  EXPECT_EQ(quota("rubbish\n\n0:\n"), std::nullopt);
}

TEST_F(CoreQuota, OfVersionOneIsThatOfItsController) {
  write("cpu,cpuacct/job/cpu.cfs_quota_us", "200000\n");
  write("cpu,cpuacct/job/cpu.cfs_period_us", "100000\n");
  const std::string groups = "5:memory:/job\n4:cpu,cpuacct:/job\n1:name=systemd:/job\n";
  EXPECT_EQ(quota(groups), 2);
  write("cpu,cpuacct/job/cpu.cfs_quota_us", "-1\n");
  EXPECT_EQ(quota(groups), std::nullopt);
}

// The driver has a file for each card, and others for all cards together.
TEST(VisibleCards, AreThoseThatHaveAFile) {
  ::unsetenv("CUDA_VISIBLE_DEVICES");
  const TemporaryFolder devices;
  EXPECT_EQ(visible_cards(devices.path() / "absent"), 0);
  for (const char* file : {"nvidiactl", "nvidia-uvm", "nvidia", "null"})
    write_durably(devices.path() / file, "");
  EXPECT_EQ(visible_cards(devices.path()), 0);
  for (const char* file : {"nvidia0", "nvidia1", "nvidia10"}) write_durably(devices.path() / file, "");
  EXPECT_EQ(visible_cards(devices.path()), 3);
}

// CUDA C++ Programming Guide, environment variables: an empty list and one that begins with an invalid number
// hide all cards.
TEST(VisibleCards, AreThoseThatTheEnvironmentNames) {
  const TemporaryFolder devices;
  write_durably(devices.path() / "nvidia0", "");
  for (const auto& [names, cards] :
       {std::pair{"", 0}, {"-1", 0}, {"2", 1}, {"0,3", 2}, {"GPU-4f,GPU-7a", 2}}) {
    ASSERT_EQ(::setenv("CUDA_VISIBLE_DEVICES", names, 1), 0);
    EXPECT_EQ(visible_cards(devices.path()), cards) << names;
  }
  ::unsetenv("CUDA_VISIBLE_DEVICES");
}

}  // namespace
}  // namespace peclet::runner
