/* Preloaded by scripts/run: whatever a process of its run listens on is reachable from this machine alone. roscpp binds the
   server of every node's slave API to all interfaces, whatever ROS_HOSTNAME says. */
#define _GNU_SOURCE
#include <arpa/inet.h>
#include <netinet/in.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

__attribute__((visibility("default"))) int bind(int socket, const struct sockaddr* address, socklen_t length) {
  struct sockaddr_storage local;
  if (length > sizeof local) return (int)syscall(SYS_bind, socket, address, length);
  memcpy(&local, address, length);
  if (address->sa_family == AF_INET && length >= sizeof(struct sockaddr_in)) {
    struct sockaddr_in* in = (struct sockaddr_in*)&local;
    if (in->sin_addr.s_addr == htonl(INADDR_ANY)) in->sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  } else if (address->sa_family == AF_INET6 && length >= sizeof(struct sockaddr_in6)) {
    struct sockaddr_in6* in = (struct sockaddr_in6*)&local;
    if (IN6_IS_ADDR_UNSPECIFIED(&in->sin6_addr)) in->sin6_addr = in6addr_loopback;
  }
  return (int)syscall(SYS_bind, socket, (struct sockaddr*)&local, length);
}
