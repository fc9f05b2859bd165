// SPDX-License-Identifier: BSD-3-Clause
package ladder_spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics;
import java.awt.event.ActionEvent;
import java.awt.image.BufferedImage;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JInternalFrame;
import javax.swing.JPanel;
import javax.swing.Timer;

import ladder_msgs.tof_frame_t;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy plugin: the live depth image of a head; near is bright, no return is dark blue. The spy finds it in the jar. */
public final class DepthImage implements SpyPlugin {
    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == tof_frame_t.LCM_FINGERPRINT;
    }

    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new AbstractAction("Depth image") {
            @Override
            public void actionPerformed(ActionEvent event) {
                final JInternalFrame window = new JInternalFrame("Depth " + channel.name, true, true);
                window.add(new View(channel));
                window.pack();
                window.setVisible(true);
                desktop.add(window);
            }
        };
    }

    /** The newest frame that the spy decoded on one channel. */
    private static final class View extends JPanel {
        private static final int PERIOD_MS = 66;
        private static final int NO_RETURN = new Color(0, 0, 60).getRGB();
        private final ChannelData channel;
        private final Timer timer = new Timer(PERIOD_MS, event -> repaint());

        View(ChannelData channel) {
            this.channel = channel;
            setPreferredSize(new Dimension(448, 342));
        }

        @Override
        public void addNotify() {
            super.addNotify();
            timer.start();
        }

        @Override
        public void removeNotify() {
            timer.stop();
            super.removeNotify();
        }

        @Override
        protected void paintComponent(Graphics graphics) {
            super.paintComponent(graphics);
            if (channel.last instanceof tof_frame_t) {
                graphics.drawImage(imageOf((tof_frame_t) channel.last), 0, 0, getWidth(), getHeight(), null);
            }
        }

        private static BufferedImage imageOf(tof_frame_t frame) {
            final int width = Math.max(frame.width_px, 1);
            final int height = Math.max(frame.height_px, 1);
            final BufferedImage image = new BufferedImage(width, height, BufferedImage.TYPE_INT_RGB);
            final int pixels = Math.min(frame.num_pixels, width * height);
            for (int i = 0; i < pixels; ++i) {
                image.setRGB(i % width, i / width, color(frame.depth_mm[i], frame.range_max_m));
            }
            return image;
        }

        private static int color(int depthMm, double rangeMaxM) {
            if (depthMm <= 0) return NO_RETURN;
            final double far = Math.min(1.0, 0.001 * depthMm / rangeMaxM);
            final int grey = (int) Math.round(255.0 * (1.0 - 0.9 * far));
            return new Color(grey, grey, grey).getRGB();
        }
    }
}
