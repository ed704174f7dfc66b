/* A Vulkan layer that simulates faults: it loses the first LOST_DEVICES devices, each while there is a file LOST, and says of every
   STALE_EVERYth image that is acquired or presented that its swapchain is out of date, or suboptimal. With BLIND no device presents.
   While there is a file HIDDEN, windows have no extent, and while there is a file REFUSED, they get no swapchains, as one that has changed just
   now. Such files grow by a byte each time. Works on one device at a time. */

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LOADER_INSTANCE_INFO = 47, LOADER_DEVICE_INFO = 48, LINK = 0, ERROR_INITIALIZATION_FAILED = -3, ERROR_DEVICE_LOST = -4,
  SUBOPTIMAL = 1000001003, ERROR_OUT_OF_DATE = -1000001004 };

typedef void (*Function)(void);
typedef Function (*GetProc)(void *, const char *);
/* VkLayerInstanceLink and VkLayerDeviceLink, which look the same. */
typedef struct Link {
  struct Link *next;
  GetProc instance_proc;
  GetProc other_proc;
} Link;
/* VkLayerInstanceCreateInfo and VkLayerDeviceCreateInfo. */
typedef struct Info {
  uint32_t type;
  struct Info *next;
  uint32_t function;
  Link *link;
} Info;

/* VkSubmitInfo. */
typedef struct Submit {
  uint32_t type;
  const void *next;
  uint32_t waits;
  const void *waited_for, *stages;
  uint32_t buffers;
  const void *buffer;
  uint32_t signals;
  const void *signalled;
} Submit;

static GetProc next_instance, next_device;
static void *instance, *device;
static int devices, gone, images;

static int number(const char *name) {
  const char *text = getenv(name);
  return text ? atoi(text) : 0;
}

static Link *take_link(const void *create, uint32_t type) {
  /* Every Vulkan struct begins with its type and the next one. */
  for (Info *info = ((Info *)create)->next; info; info = info->next)
    if (info->type == type && info->function == LINK) {
      Link *link = info->link;
      info->link = link->next;
      return link;
    }
  return NULL;
}

static int32_t create_instance(const void *create, const void *allocator, void **made) {
  Link *link = take_link(create, LOADER_INSTANCE_INFO);
  if (!link) return ERROR_INITIALIZATION_FAILED;
  next_instance = link->instance_proc;
  int32_t (*next)(const void *, const void *, void **) = (void *)next_instance(NULL, "vkCreateInstance");
  int32_t result = next(create, allocator, made);
  instance = *made;
  return result;
}

static int32_t create_device(void *physical, const void *create, const void *allocator, void **made) {
  Link *link = take_link(create, LOADER_DEVICE_INFO);
  if (!link) return ERROR_INITIALIZATION_FAILED;
  next_device = link->other_proc;
  int32_t (*next)(void *, const void *, const void *, void **) =
      (void *)link->instance_proc(instance, "vkCreateDevice");
  int32_t result = next(physical, create, allocator, made);
  device = *made;
  devices++;
  gone = 0;
  return result;
}

static int32_t wait_idle(void *of) {
  int32_t (*next)(void *) = (void *)next_device(device, "vkDeviceWaitIdle");
  int32_t result = next(of);
  return gone ? ERROR_DEVICE_LOST : result;
}

static int32_t queue_wait_idle(void *queue) {
  int32_t (*next)(void *) = (void *)next_device(device, "vkQueueWaitIdle");
  int32_t result = next(queue);
  return gone ? ERROR_DEVICE_LOST : result;
}

/* Whether there is the file that a variable names, which then grows. */
static int is_there(const char *variable) {
  const char *path = getenv(variable);
  FILE *file = path ? fopen(path, "r+") : NULL;
  if (!file) return 0;
  fseek(file, 0, SEEK_END);
  fputc('.', file);
  fclose(file);
  return 1;
}

static int32_t submit(void *queue, uint32_t count, const Submit *what, uint64_t fence) {
  /* What signals a semaphore is a frame for the window. */
  int frame = count && what->signals;
  if (frame && !gone && devices <= number("LOST_DEVICES") && is_there("LOST")) {
    /* What is under way ends: a driver that has lost its device does not use anything any more. */
    queue_wait_idle(queue);
    gone = 1;
  }
  if (gone) return ERROR_DEVICE_LOST;
  int32_t (*next)(void *, uint32_t, const void *, uint64_t) = (void *)next_device(device, "vkQueueSubmit");
  return next(queue, count, what, fence);
}

static int32_t wait_for_fences(void *of, uint32_t count, const uint64_t *fences, uint32_t all, uint64_t timeout) {
  if (gone) return ERROR_DEVICE_LOST;
  int32_t (*next)(void *, uint32_t, const uint64_t *, uint32_t, uint64_t) =
      (void *)next_device(device, "vkWaitForFences");
  return next(of, count, fences, all, timeout);
}

/* 0, or what to say of the next image instead of that all is well: one and the other in turn. */
static int32_t stale(void) {
  int every = number("STALE_EVERY");
  if (!every || ++images % every) return 0;
  return images / every % 2 ? ERROR_OUT_OF_DATE : SUBOPTIMAL;
}

static int32_t acquire(void *of, uint64_t chain, uint64_t timeout, uint64_t semaphore, uint64_t fence, uint32_t *index) {
  int32_t (*next)(void *, uint64_t, uint64_t, uint64_t, uint64_t, uint32_t *) =
      (void *)next_device(device, "vkAcquireNextImageKHR");
  int32_t said = stale();
  /* Of what is out of date nothing is acquired. */
  if (said == ERROR_OUT_OF_DATE) return said;
  int32_t result = next(of, chain, timeout, semaphore, fence, index);
  return result ? result : said;
}

static int32_t present(void *queue, const void *what) {
  if (gone) return ERROR_DEVICE_LOST;
  int32_t (*next)(void *, const void *) = (void *)next_device(device, "vkQueuePresentKHR");
  int32_t result = next(queue, what);
  return result ? result : stale();
}

static int32_t presents(void *physical, uint32_t family, uint64_t surface, uint32_t *does) {
  int32_t (*next)(void *, uint32_t, uint64_t, uint32_t *) =
      (void *)next_instance(instance, "vkGetPhysicalDeviceSurfaceSupportKHR");
  int32_t result = next(physical, family, surface, does);
  if (number("BLIND")) *does = 0;
  return result;
}

/* VkSurfaceCapabilitiesKHR begins with the least and the greatest number of images, and the present, least and greatest extent. */
static int32_t capabilities(void *physical, uint64_t surface, uint32_t *can) {
  int32_t (*next)(void *, uint64_t, uint32_t *) =
      (void *)next_instance(instance, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  int32_t result = next(physical, surface, can);
  if (is_there("HIDDEN")) memset(can + 2, 0, 6 * sizeof *can);
  return result;
}

static int32_t create_swapchain(void *of, const void *create, const void *allocator, uint64_t *made) {
  static int refused;
  if (is_there("REFUSED")) return refused++ % 2 ? ERROR_OUT_OF_DATE : ERROR_INITIALIZATION_FAILED;
  int32_t (*next)(void *, const void *, const void *, uint64_t *) = (void *)next_device(device, "vkCreateSwapchainKHR");
  return next(of, create, allocator, made);
}

Function faults_instance_proc(void *of, const char *name);
Function faults_device_proc(void *of, const char *name);

static Function own(const char *name) {
  const struct { const char *name; Function function; } all[] = {
    {"vkGetInstanceProcAddr", (Function)faults_instance_proc}, {"vkGetDeviceProcAddr", (Function)faults_device_proc},
    {"vkCreateInstance", (Function)create_instance},         {"vkCreateDevice", (Function)create_device},
    {"vkQueueSubmit", (Function)submit},                     {"vkWaitForFences", (Function)wait_for_fences},
    {"vkAcquireNextImageKHR", (Function)acquire},            {"vkQueuePresentKHR", (Function)present},
    {"vkGetPhysicalDeviceSurfaceSupportKHR", (Function)presents},
    {"vkGetPhysicalDeviceSurfaceCapabilitiesKHR", (Function)capabilities},
    {"vkCreateSwapchainKHR", (Function)create_swapchain},
    {"vkDeviceWaitIdle", (Function)wait_idle},               {"vkQueueWaitIdle", (Function)queue_wait_idle},
  };
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (!strcmp(all[i].name, name)) return all[i].function;
  return NULL;
}

Function faults_instance_proc(void *of, const char *name) {
  Function found = own(name);
  return found ? found : next_instance ? next_instance(of, name) : NULL;
}

Function faults_device_proc(void *of, const char *name) {
  Function found = own(name);
  return found ? found : next_device ? next_device(of, name) : NULL;
}
