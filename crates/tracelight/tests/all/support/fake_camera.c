/* A camera that is not there, for tests: loaded before the C library (LD_PRELOAD), it answers for /dev/video42 as a Video4Linux
 * driver does, by the kernel's own header. What it is like, the environment says: FAKE_CAMERA=key=value,… and, for each coding it
 * sends, a file of that name in FAKE_CAMERA_IMAGES. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#define DEVICE "/dev/video42"
#define BUFFERS 4
#define ROOM (16u << 20)

static int device = -1;      /* what was opened last, shared memory with room for the images */
static int opened;           /* how many times it is */
static unsigned char *room;  /* the same, mapped here */
static unsigned char *image; /* as it is on the wall */
static size_t image_bytes;
static unsigned coding;
static int width, height, is_streaming, queued[BUFFERS];
static double begun; /* when images began to come, s */
static long next;    /* number of the next image */

/* What light an image gets is settled when it begins; what was told later is for those that come after. */
struct told { double since, light; };
static struct told past[1000];
static int pasts;

struct control {
    unsigned id, kind;
    const char *name;
    int least, most, value;
};
static struct control controls[] = {
    {V4L2_CID_GAIN, V4L2_CTRL_TYPE_INTEGER, "Gain", 0, 192, 64},
    {V4L2_CID_EXPOSURE_AUTO, V4L2_CTRL_TYPE_MENU, "Auto Exposure", 0, 3, 3},
    {V4L2_CID_EXPOSURE_ABSOLUTE, V4L2_CTRL_TYPE_INTEGER, "Exposure Time, Absolute", 1, 5000, 157},
    {V4L2_CID_EXPOSURE_AUTO_PRIORITY, V4L2_CTRL_TYPE_BOOLEAN, "Exposure, Dynamic Framerate", 0, 1, 1},
    {V4L2_CID_FOCUS_AUTO, V4L2_CTRL_TYPE_BOOLEAN, "Focus, Automatic Continuous", 0, 1, 1},
    {V4L2_CID_FOCUS_AUTO + 0x1000, 0x0107 /* a rectangle: younger than most programs */, "Region", 0, 1, 0},
};
#define CONTROLS (sizeof controls / sizeof *controls)

/* What the environment says of the camera. */
static double told(const char *key, double otherwise)
{
    const char *all = getenv("FAKE_CAMERA");
    size_t length = strlen(key);
    for (const char *at = all; at && *at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
        if (!strncmp(at, key, length) && at[length] == '=')
            return atof(at + length + 1);
    return otherwise;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static int fails(int error)
{
    errno = error;
    return -1;
}

static double rate(void) { return told("rate", 30); }

/* When an image arrives. */
static double due(long number) { return begun + number / rate() + told("late", 0.06); }

static int is_gone(void) { return next >= told("unplug", 1e9); }

static const char *codings[] = {"MJPG", "YUYV", "GREY", "H264"};

/* Whether the camera sends a coding: whether there is an image of it. H264 it lists, and nobody here can read it. */
static FILE *image_of(unsigned name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%.4s", getenv("FAKE_CAMERA_IMAGES"), (const char *)&name);
    return fopen(path, "rb");
}

static unsigned nth_coding(unsigned index)
{
    for (size_t k = 0; k < 4; k++) {
        unsigned name;
        memcpy(&name, codings[k], 4);
        FILE *file = k == 3 ? NULL : image_of(name);
        if (file)
            fclose(file);
        if ((file || k == 3) && index-- == 0)
            return name;
    }
    return 0;
}

static int set_format(struct v4l2_format *f)
{
    FILE *file = image_of(f->fmt.pix.pixelformat);
    if (told("busy", 0))
        return fails(EBUSY);
    if (file) {
        coding = f->fmt.pix.pixelformat;
        image = realloc(image, ROOM);
        image_bytes = fread(image, 1, ROOM, file);
        fclose(file);
    }
    width = told("width", 1280), height = told("height", 720);
    return 0;
}

static int get_format(struct v4l2_format *f)
{
    unsigned type = f->type;
    memset(f, 0, sizeof *f);
    f->type = type;
    f->fmt.pix.width = width, f->fmt.pix.height = height, f->fmt.pix.pixelformat = coding;
    f->fmt.pix.field = V4L2_FIELD_NONE;
    f->fmt.pix.bytesperline = coding == V4L2_PIX_FMT_YUYV ? 2 * width : coding == V4L2_PIX_FMT_GREY ? width : 0;
    f->fmt.pix.sizeimage = ROOM;
    f->fmt.pix.colorspace = V4L2_COLORSPACE_SRGB;
    return 0;
}

/* By how much an image is brighter than the wall: one of 10 ms at gain 64 is not. */
static double light(void)
{
    struct control *gain = &controls[0], *automatic = &controls[1], *exposure = &controls[2];
    return automatic->value == V4L2_EXPOSURE_MANUAL ? exposure->value / 100.0 * (gain->value + 1) / 65.0 : 1.0;
}

/* An image as it was exposed, one and a half images before it began to arrive. */
static size_t expose(unsigned char *to, size_t bytes, double began)
{
    double light = told("light", 1.0);
    int k = pasts - 1;
    while (k > 0 && past[k].since > began - 1.5 / rate())
        k--;
    light *= pasts ? past[k].light : 1.0;
    memcpy(to, image, bytes);
    unsigned step = coding == V4L2_PIX_FMT_YUYV ? 2 : 1;
    if (coding != V4L2_PIX_FMT_MJPEG)
        for (size_t at = 0; at < bytes; at += step) {
            double level = 16 + (to[at] - 16) * light + (at / step + next) % 2;
            to[at] = level > 255 ? 255 : level < 0 ? 0 : level;
        }
    return bytes;
}

static int dequeue(struct v4l2_buffer *b)
{
    int found = -1;
    if (is_gone())
        return fails(ENODEV);
    if (next >= told("stall", 1e9) || now() < due(next))
        return fails(EAGAIN);
    /* what nobody fetched in time is lost */
    while (due(next + BUFFERS) < now())
        next++;
    for (int k = 0; k < BUFFERS; k++)
        if (queued[k] && (found < 0 || queued[k] < queued[found]))
            found = k;
    if (found < 0)
        return fails(EAGAIN);
    queued[found] = 0;
    double began = begun + next / rate();
    int every = told("broken", 0);
    int is_broken = every && next % every == every - 1;
    b->index = found;
    b->bytesused = expose(room + (size_t)found * ROOM, is_broken ? image_bytes / 2 : image_bytes, began);
    if (told("endless", 0))
        b->bytesused -= 2;
    b->flags = V4L2_BUF_FLAG_DONE | (is_broken ? V4L2_BUF_FLAG_ERROR : 0);
    b->flags |= told("stamps", 1) ? V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE : 0;
    b->field = V4L2_FIELD_NONE;
    b->timestamp.tv_sec = began, b->timestamp.tv_usec = 1e6 * (began - (long)began);
    b->sequence = next++;
    return 0;
}

static struct control *control(unsigned id)
{
    for (size_t k = 0; k < CONTROLS; k++)
        if (controls[k].id == id && !(told("auto", 0) && (k == 1 || k == 2)) && !(k == 5 && !told("young", 0)))
            return &controls[k];
    return NULL;
}

static int query(struct v4l2_query_ext_ctrl *q)
{
    struct control *c = NULL;
    unsigned id = q->id & ~(V4L2_CTRL_FLAG_NEXT_CTRL | V4L2_CTRL_FLAG_NEXT_COMPOUND);
    if (id == q->id)
        c = control(id);
    else
        for (size_t k = 0; k < CONTROLS; k++)
            if (controls[k].id > id && control(controls[k].id) && (!c || controls[k].id < c->id))
                c = &controls[k];
    if (!c)
        return fails(EINVAL);
    memset(q, 0, sizeof *q);
    q->id = c->id, q->type = c->kind, q->minimum = c->least, q->maximum = c->most, q->step = 1;
    q->default_value = c->value;
    snprintf(q->name, sizeof q->name, "%s", c->name);
    return 0;
}

static void log_told(const char *name, int value)
{
    const char *path = getenv("FAKE_CAMERA_LOG");
    FILE *log = path ? fopen(path, "a") : NULL;
    if (log) {
        fprintf(log, "%s=%d\n", name, value);
        fclose(log);
    }
}

static int set_control(struct v4l2_ext_control *e)
{
    struct control *c = control(e->id);
    if (!c)
        return fails(EINVAL);
    if (c->id == V4L2_CID_EXPOSURE_ABSOLUTE && controls[1].value != V4L2_EXPOSURE_MANUAL)
        return log_told("refused", e->value), fails(EACCES);
    static int busy;
    if (busy++ % 3 == 0)
        return fails(EBUSY); /* for a moment, with what it was told before */
    /* as drivers of webcams do, without signs */
    unsigned value = e->value, least = c->least, most = c->most;
    c->value = value < least ? least : value > most ? most : value;
    if (pasts < 1000)
        past[pasts++] = (struct told){now(), light()};
    log_told(c->name, c->value);
    return 0;
}

static int answer(unsigned long request, void *argument)
{
    switch (request) {
    case VIDIOC_QUERYCAP: {
        struct v4l2_capability *c = argument;
        memset(c, 0, sizeof *c);
        strcpy((char *)c->driver, "fake"), strcpy((char *)c->card, "A camera that is not there");
        c->device_caps = told("meta", 0) ? V4L2_CAP_META_CAPTURE : V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
        c->capabilities = c->device_caps | V4L2_CAP_DEVICE_CAPS;
        return 0;
    }
    case VIDIOC_ENUM_FMT: {
        struct v4l2_fmtdesc *d = argument;
        d->pixelformat = nth_coding(d->index);
        snprintf((char *)d->description, sizeof d->description, "%.4s", (const char *)&d->pixelformat);
        return d->pixelformat ? 0 : fails(EINVAL);
    }
    case VIDIOC_ENUM_FRAMESIZES: {
        struct v4l2_frmsizeenum *s = argument;
        s->type = V4L2_FRMSIZE_TYPE_DISCRETE;
        s->discrete.width = told("width", 1280), s->discrete.height = told("height", 720);
        return s->index ? fails(EINVAL) : 0;
    }
    case VIDIOC_ENUM_FRAMEINTERVALS: {
        struct v4l2_frmivalenum *i = argument;
        i->type = V4L2_FRMIVAL_TYPE_DISCRETE;
        i->discrete.numerator = i->index + 1, i->discrete.denominator = rate();
        return i->index > 2 ? fails(EINVAL) : 0;
    }
    case VIDIOC_S_FMT: return set_format(argument);
    case VIDIOC_G_FMT: return get_format(argument);
    case VIDIOC_S_PARM:
    case VIDIOC_G_PARM: return 0;
    case VIDIOC_REQBUFS: {
        struct v4l2_requestbuffers *r = argument;
        r->count = r->count > BUFFERS ? BUFFERS : r->count;
        return 0;
    }
    case VIDIOC_QUERYBUF: {
        struct v4l2_buffer *b = argument;
        b->length = ROOM, b->m.offset = b->index * ROOM;
        return 0;
    }
    case VIDIOC_QBUF: {
        static int order;
        int *slot = &queued[((struct v4l2_buffer *)argument)->index];
        return *slot ? fails(EINVAL) : (*slot = ++order, 0);
    }
    case VIDIOC_DQBUF: return dequeue(argument);
    case VIDIOC_STREAMON:
        if (told("narrow", 0))
            return fails(ENOSPC);
        usleep(200000); /* webcams take their time */
        begun = now(), is_streaming = 1;
        return 0;
    case VIDIOC_STREAMOFF: is_streaming = 0; return is_gone() ? fails(ENODEV) : 0;
    case VIDIOC_QUERY_EXT_CTRL: return query(argument);
    case VIDIOC_QUERYMENU: return ((struct v4l2_querymenu *)argument)->index % 2 ? 0 : fails(EINVAL);
    case VIDIOC_G_EXT_CTRLS: {
        struct v4l2_ext_control *e = ((struct v4l2_ext_controls *)argument)->controls;
        struct control *c = control(e->id);
        if (c)
            e->value = c->value;
        return c ? 0 : fails(EINVAL);
    }
    case VIDIOC_S_EXT_CTRLS: return set_control(((struct v4l2_ext_controls *)argument)->controls);
    default: return fails(ENOTTY);
    }
}

static int open_fake(void)
{
    if (told("denied", 0))
        return fails(EACCES);
    int file = memfd_create("fake camera", 0);
    if (file < 0 || ftruncate(file, (off_t)BUFFERS * ROOM))
        return -1;
    room = mmap(NULL, (size_t)BUFFERS * ROOM, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    opened++;
    return device = file;
}

#define NEXT(name) (__typeof__(&name))dlsym(RTLD_NEXT, #name)

int open(const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    mode_t mode = va_arg(more, mode_t);
    va_end(more);
    return strcmp(path, DEVICE) ? (NEXT(open))(path, flags, mode) : open_fake();
}

int open64(const char *path, int flags, ...) __attribute__((alias("open")));

long syscall(long number, ...)
{
    static long (*next_syscall)(long, ...);
    long a[6];
    va_list more;
    va_start(more, number);
    for (int k = 0; k < 6; k++)
        a[k] = va_arg(more, long);
    va_end(more);
    if (number == SYS_ioctl && device >= 0 && a[0] == device)
        return answer((unsigned long)a[1] & 0xffffffff, (void *)a[2]);
    if (!next_syscall)
        next_syscall = NEXT(syscall);
    return next_syscall(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}

#pragma GCC diagnostic ignored "-Wmaybe-uninitialized" /* its declaration says that files are written, and not that they are read */
int poll(struct pollfd *files, nfds_t count, int timeout)
{
    if (count != 1 || device < 0 || files->fd != device)
        return (NEXT(poll))(files, count, timeout);
    for (double until = timeout < 0 ? 1e18 : now() + timeout / 1000.0; now() < until; usleep(1000)) {
        if (is_gone())
            return files->revents = POLLERR, 1;
        if (is_streaming && next < told("stall", 1e9) && now() >= due(next))
            return files->revents = POLLIN, 1;
    }
    return 0;
}
