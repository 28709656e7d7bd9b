// SPDX-License-Identifier: GPL-2.0-only
/*
 * An SPI controller whose chips are a program: what lies under one chip select goes to /dev/nanotouch-bus, and comes
 * back from there with the answer or an error. The kernel's own spidev binds to its devices, spi0.0 and spi0.1.
 *
 * It becomes a part of a test kernel, hence the licence. It is no part of the library, of a wheel or of an install.
 */
#include <linux/completion.h>
#include <linux/fs.h>
#include <linux/init.h>
#include <linux/miscdevice.h>
#include <linux/platform_device.h>
#include <linux/poll.h>
#include <linux/spi/spi.h>
#include <linux/uaccess.h>

#include "nanotouch_bus.h"

static struct nanotouch_frame asked, answered;
static DECLARE_WAIT_QUEUE_HEAD(waiting);
static DECLARE_COMPLETION(answer);
static bool is_open, is_asked;
static struct platform_device *platform;
static struct spi_controller *bus;

/* Nobody there: the line floats high. Nobody answers: a second is waited. */
static int exchange(struct spi_device *spi, u32 clock, u32 length)
{
	if (!READ_ONCE(is_open)) {
		memset(answered.bytes, 0xff, length);
		answered.error = 0;
		answered.length = length;
		return 0;
	}
	asked.sequence++;
	asked.chip = spi_get_chipselect(spi, 0);
	asked.mode = spi->mode & SPI_MODE_X_MASK;
	asked.clock = clock;
	asked.length = length;
	reinit_completion(&answer);
	smp_store_release(&is_asked, true);
	wake_up(&waiting);
	if (!wait_for_completion_timeout(&answer, HZ))
		return -ETIMEDOUT;
	return answered.error;
}

/* As the kernel's own loop does (spi_transfer_one_message), each transfer counts as whole, whatever came of it. */
static void hand_out(struct spi_message *message, struct spi_transfer *first, struct spi_transfer *last)
{
	u32 at = 0;

	for (;; first = list_next_entry(first, transfer_list)) {
		if (first->rx_buf && answered.length > at)
			memcpy(first->rx_buf, answered.bytes + at, min(first->len, answered.length - at));
		at += first->len;
		message->actual_length += first->len;
		if (first == last)
			return;
	}
}

static int take_message(struct spi_controller *controller, struct spi_message *message)
{
	struct spi_transfer *transfer, *first = NULL;
	u32 length = 0;
	int error = 0;

	list_for_each_entry(transfer, &message->transfers, transfer_list) {
		first = first ? first : transfer;
		if (length + transfer->len > NANOTOUCH_FRAME) {
			error = -EMSGSIZE;
			break;
		}
		if (transfer->tx_buf)
			memcpy(asked.bytes + length, transfer->tx_buf, transfer->len);
		else
			memset(asked.bytes + length, 0, transfer->len);
		length += transfer->len;
		if (!transfer->cs_change && !list_is_last(&transfer->transfer_list, &message->transfers))
			continue;
		error = exchange(message->spi, transfer->speed_hz, length);
		if (error)
			break;
		hand_out(message, first, transfer);
		first = NULL;
		length = 0;
	}
	message->status = error;
	spi_finalize_current_message(controller);
	return error;
}

static ssize_t bus_read(struct file *file, char __user *to, size_t size, loff_t *at)
{
	int error = wait_event_interruptible(waiting, smp_load_acquire(&is_asked));

	if (error)
		return error;
	if (size < sizeof(asked))
		return -EINVAL;
	is_asked = false;
	return copy_to_user(to, &asked, sizeof(asked)) ? -EFAULT : sizeof(asked);
}

static ssize_t bus_write(struct file *file, const char __user *from, size_t size, loff_t *at)
{
	if (size != sizeof(answered) || copy_from_user(&answered, from, size))
		return -EINVAL;
	if (answered.sequence != asked.sequence || answered.error < -MAX_ERRNO || answered.error > 0 ||
	    answered.length > asked.length)
		return -ESTALE;
	complete(&answer);
	return size;
}

static __poll_t bus_poll(struct file *file, poll_table *table)
{
	poll_wait(file, &waiting, table);
	return EPOLLOUT | (smp_load_acquire(&is_asked) ? EPOLLIN : 0);
}

static int bus_open(struct inode *inode, struct file *file)
{
	if (cmpxchg(&is_open, false, true))
		return -EBUSY;
	is_asked = false;
	return 0;
}

static int bus_release(struct inode *inode, struct file *file)
{
	WRITE_ONCE(is_open, false);
	return 0;
}

static const struct file_operations operations = {
	.owner = THIS_MODULE,
	.read = bus_read,
	.write = bus_write,
	.poll = bus_poll,
	.open = bus_open,
	.release = bus_release,
};
static struct miscdevice device = {
	.minor = MISC_DYNAMIC_MINOR, .name = "nanotouch-bus", .fops = &operations};

static int __init bus_start(void)
{
	int chip, error;

	platform = platform_device_register_simple("nanotouch-bus", -1, NULL, 0);
	if (IS_ERR(platform))
		return PTR_ERR(platform);
	bus = spi_alloc_host(&platform->dev, 0);
	if (!bus)
		return -ENOMEM;
	bus->bus_num = 0;
	bus->num_chipselect = 2;
	bus->mode_bits = SPI_MODE_X_MASK;
	bus->bits_per_word_mask = SPI_BPW_MASK(8);
	bus->max_speed_hz = 50000000;
	bus->transfer_one_message = take_message;
	error = spi_register_controller(bus);
	if (error)
		return error;
	for (chip = 0; chip < 2; chip++) {
		/* a name of spidev's own table: it refuses others */
		struct spi_board_info info = {.modalias = "ltc2488", .max_speed_hz = 20000000, .chip_select = chip};

		if (!spi_new_device(bus, &info))
			return -ENODEV;
	}
	return misc_register(&device);
}
late_initcall(bus_start);
