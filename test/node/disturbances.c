/* Preloaded into the node by a test: its wall clock is off by what stands in the file $CLOCK_JUMP, a double [s], and
   the machine holds its publishing thread up for a second after each message on the topic $HOLD_UP, and with $SEND_LATE
   the thread of roscpp that sends, after each round. The clock that only goes on is left alone. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static const volatile double* offset;

__attribute__((constructor)) static void find_offset(void) {
  const char* path = getenv("CLOCK_JUMP");
  const int file = path ? open(path, O_RDONLY) : -1;
  void* memory = file < 0 ? MAP_FAILED : mmap(NULL, sizeof *offset, PROT_READ, MAP_SHARED, file, 0);
  if (memory != MAP_FAILED) offset = memory;
}

int clock_gettime(clockid_t clock, struct timespec* now) {
  const int result = (int)syscall(SYS_clock_gettime, clock, now);
  if (result == 0 && offset && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
    now->tv_sec += (time_t)*offset;
  return result;
}

int gettimeofday(struct timeval* restrict now, void* restrict zone) {
  struct timespec time;
  (void)zone;
  clock_gettime(CLOCK_REALTIME, &time);
  now->tv_sec = time.tv_sec;
  now->tv_usec = time.tv_nsec / 1000;
  return 0;
}

time_t time(time_t* now) {
  struct timespec time;
  clock_gettime(CLOCK_REALTIME, &time);
  if (now) *now = time.tv_sec;
  return time.tv_sec;
}

/* Waits until a time of day go by the clock that the program sees. */
int sem_timedwait(void* semaphore, const struct timespec* end);
int sem_clockwait(void* semaphore, clockid_t clock, const struct timespec* end);
int sem_timedwait(void* semaphore, const struct timespec* end) {
  struct timespec real = *end;
  if (offset) real.tv_sec -= (time_t)*offset;
  return sem_clockwait(semaphore, CLOCK_REALTIME, &real);
}

#define PUBLISH /* ros::TopicManager::publish */           \
  "_ZN3ros12TopicManager7publishE"                         \
  "RKNSt7__cxx1112basic_stringIcSt11char_traitsIcESaIcEEE" \
  "RKN5boost8functionIFNS_17SerializedMessageEvEEERSB_"
void publish(void* manager, const void* topic, const void* serialize, void* message) __asm__(PUBLISH);
void publish(void* manager, const void* topic, const void* serialize, void* message) {
  void (*next)(void*, const void*, const void*, void*) = dlsym(RTLD_NEXT, PUBLISH);
  const char* held_up = getenv("HOLD_UP");
  next(manager, topic, serialize, message);
  if (!held_up || strcmp(*(const char* const*)topic, held_up) != 0) return; /* a std::string begins with its text */
  fputs("held up\n", stderr);
  sleep(1);
}

#define SEND "_ZN3ros12TopicManager20processPublishQueuesEv"
void send_published(void* manager) __asm__(SEND);
void send_published(void* manager) {
  void (*next)(void*) = dlsym(RTLD_NEXT, SEND);
  next(manager);
  if (!getenv("SEND_LATE")) return;
  fputs("sent late\n", stderr);
  usleep(30000);
}
