// SPDX-License-Identifier: GPL-3.0-or-later
// A plugin of QEMU that prints how many instructions a program has executed. Debian has no header of this interface, whose
// version 1 is that of QEMU 4.2 to 8.
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef uint64_t plugin_id;
struct info;
struct block;
enum { add_u64 = 0 };  // the only inline operation

void qemu_plugin_register_vcpu_tb_trans_cb(plugin_id id, void (*translated)(plugin_id, struct block*));
void qemu_plugin_register_vcpu_tb_exec_inline(struct block* block, int operation, void* counter, uint64_t value);
size_t qemu_plugin_tb_n_insns(const struct block* block);
void qemu_plugin_register_atexit_cb(plugin_id id, void (*ended)(plugin_id, void*), void* data);

int qemu_plugin_version = 1;

static uint64_t executed;

static void count_block(plugin_id id, struct block* block) {
  (void)id;
  qemu_plugin_register_vcpu_tb_exec_inline(block, add_u64, &executed, qemu_plugin_tb_n_insns(block));
}

static void print(plugin_id id, void* data) {
  (void)id;
  (void)data;
  printf("%llu\n", (unsigned long long)executed);
  fflush(stdout);
}

int qemu_plugin_install(plugin_id id, const struct info* info, int count, char** arguments) {
  (void)info;
  (void)count;
  (void)arguments;
  qemu_plugin_register_vcpu_tb_trans_cb(id, count_block);
  qemu_plugin_register_atexit_cb(id, print, NULL);
  return 0;
}
