// A layer of Vulkan that loses the device once the file named by LOSE_DEVICE_AT is there, as drivers do when a GPU hangs or is unplugged:
// from then on whatever waits for the device or gives it work returns VK_ERROR_DEVICE_LOST.

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef int Result;
typedef void (*Function)(void);
typedef Function (*Lookup)(void *handle, const char *name);

enum { DEVICE_LOST = -4, LOADER_INSTANCE_CREATE_INFO = 47, LOADER_DEVICE_CREATE_INFO = 48, LINK_INFO = 0 };

// vk_layer.h's: what lies below this layer.
struct Link { struct Link *next; Lookup of_instance, of_device; };
struct Info { int type; struct Info *next; int function; struct Link *link; };
struct Interface { int type; void *next; uint32_t version; Lookup of_instance, of_device, of_physical_device; };

static Lookup below_instance, below_device;
static void *instance_below;

static int is_lost(void) {
    const char *path = getenv("LOSE_DEVICE_AT");
    return path && access(path, F_OK) == 0;
}

#define LOSING(name, parameters, arguments)           \
    static Result(*below_##name) parameters;          \
    static Result name parameters { return is_lost() ? DEVICE_LOST : below_##name arguments; }

LOSING(vkQueueSubmit, (void *queue, uint32_t count, void *submits, uint64_t fence), (queue, count, submits, fence))
LOSING(vkQueueWaitIdle, (void *queue), (queue))
LOSING(vkDeviceWaitIdle, (void *device), (device))
LOSING(vkWaitForFences, (void *device, uint32_t count, void *fences, uint32_t all, uint64_t time), (device, count, fences, all, time))
LOSING(vkGetFenceStatus, (void *device, uint64_t fence), (device, fence))
LOSING(vkWaitSemaphores, (void *device, void *info, uint64_t time), (device, info, time))
LOSING(vkGetSemaphoreCounterValue, (void *device, uint64_t semaphore, uint64_t *value), (device, semaphore, value))
LOSING(vkQueuePresentKHR, (void *queue, void *info), (queue, info))
LOSING(vkAcquireNextImageKHR, (void *device, uint64_t chain, uint64_t time, uint64_t semaphore, uint64_t fence, uint32_t *index),
       (device, chain, time, semaphore, fence, index))

static struct Link *take_link(struct Info *info, int type) {
    for (info = info->next; info->type != type || info->function != LINK_INFO;) info = info->next;
    struct Link *link = info->link;
    info->link = link->next;
    return link;
}

static Result vkCreateInstance(struct Info *info, void *allocator, void **instance) {
    below_instance = take_link(info, LOADER_INSTANCE_CREATE_INFO)->of_instance;
    Result (*create)(void *, void *, void **) = (void *)below_instance(NULL, "vkCreateInstance");
    Result result = create(info, allocator, instance);
    instance_below = *instance;
    return result;
}

static Result vkCreateDevice(void *physical, struct Info *info, void *allocator, void **device) {
    below_device = take_link(info, LOADER_DEVICE_CREATE_INFO)->of_device;
    Result (*create)(void *, void *, void *, void **) = (void *)below_instance(instance_below, "vkCreateDevice");
    return create(physical, info, allocator, device);
}

static Function of_device(void *device, const char *name) {
#define OFFER(wanted)                                            \
    if (strcmp(name, #wanted) == 0) {                            \
        below_##wanted = (void *)below_device(device, #wanted);  \
        return (Function)wanted;                                 \
    }
    OFFER(vkQueueSubmit) OFFER(vkQueueWaitIdle) OFFER(vkDeviceWaitIdle) OFFER(vkWaitForFences) OFFER(vkGetFenceStatus)
    OFFER(vkWaitSemaphores) OFFER(vkGetSemaphoreCounterValue) OFFER(vkQueuePresentKHR) OFFER(vkAcquireNextImageKHR)
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) return (Function)of_device;
    return below_device(device, name);
}

static Function of_instance(void *instance, const char *name) {
    if (strcmp(name, "vkCreateInstance") == 0) return (Function)vkCreateInstance;
    if (strcmp(name, "vkCreateDevice") == 0) return (Function)vkCreateDevice;
    if (strcmp(name, "vkGetInstanceProcAddr") == 0) return (Function)of_instance;
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) return (Function)of_device;
    return below_instance ? below_instance(instance, name) : NULL;
}

Result vkNegotiateLoaderLayerInterfaceVersion(struct Interface *interface) {
    interface->version = 2;
    interface->of_instance = of_instance;
    interface->of_device = of_device;
    interface->of_physical_device = NULL;
    return 0;
}
